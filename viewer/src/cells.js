// All cells: one draw call a type. Where atoms are and what colours show stand in textures; normals are found in the shader.

import * as THREE from 'three';
import { LIGHT } from './light.js';
import { meshOf, partsFor, refined } from './mesh.js';
import { position } from './source.js';

const WIDE = 2048;

const VERTEX = `
precision highp float;
precision highp int;
precision highp usampler2D;
precision highp sampler2D;
uniform mat4 viewMatrix, projectionMatrix;
uniform usampler2D atoms;
uniform usampler2D rings;
uniform usampler2D cornersOf;
uniform sampler2D numbers;
uniform vec3 low, sides;
uniform sampler2D restOf; // where atoms lie at rest from the middle of the cell, of types that are marked
uniform bool isMarked;
uniform int shows; // 0 types, 1 a number a cell, 2 a number an atom
#ifdef SHADOW
uniform vec3 ground, floor_, fall;
uniform float lift;
#endif
in vec3 corners; // three corners of the mesh
in vec3 weights; // of the second and of the third; whether the skin is bent between them
in vec2 owner;   // first atom, number of the cell
out vec3 world;
out vec3 bent;
out float number;
out vec3 mark;
flat out int cell;

ivec2 at(int index) { return ivec2(index & ${WIDE - 1}, index >> 11); }
vec3 where_(int atom) { return low + sides * (vec3(texelFetch(atoms, at(atom), 0).xyz) / 65535.0); }

// The position of a corner, its normal, and its number.
void look(float corner, int first, out vec3 here, out vec3 normal, out float found, out vec3 own) {
  uvec3 c = texelFetch(cornersOf, at(int(corner)), 0).xyz; // atom, start of its ring, neighbours
  int atom = first + int(c.x), start = int(c.y), end = start + int(c.z);
  here = where_(atom);
  normal = vec3(0.0);
  vec3 last = where_(first + int(texelFetch(rings, at(start), 0).x)) - here;
  for (int k = start + 1; k < end; k++) {
    vec3 next = where_(first + int(texelFetch(rings, at(k), 0).x)) - here;
    normal += cross(last, next);
    last = next;
  }
  normal = normalize(normal);
  found = shows == 2 ? texelFetch(numbers, at(atom), 0).x : 0.0;
  own = isMarked ? texelFetch(restOf, at(int(c.x)), 0).xyz : vec3(1.0);
}

void main() {
  int first = int(owner.x);
  cell = int(owner.y);
  vec3 p[3], n[3], m[3];
  float f[3];
  look(corners.x, first, p[0], n[0], f[0], m[0]);
  world = p[0];
  bent = n[0];
  number = f[0];
  mark = m[0];
  if (weights.x > 0.0 || weights.y > 0.0) {
    float[3] w = float[3](1.0 - weights.x - weights.y, weights.x, weights.y);
    look(corners.y, first, p[1], n[1], f[1], m[1]);
    if (w[2] > 0.0) look(corners.z, first, p[2], n[2], f[2], m[2]);
    else { p[2] = p[1]; n[2] = n[1]; f[2] = f[1]; m[2] = m[1]; }
    vec3 flat_ = w[0] * p[0] + w[1] * p[1] + w[2] * p[2];
    // Phong tessellation (Boubekeur and Alexa 2008): drawn to the tangent planes of the corners, through which it goes.
    vec3 lifted = vec3(0.0);
    for (int k = 0; k < 3; k++) lifted += w[k] * (flat_ - dot(flat_ - p[k], n[k]) * n[k]);
    world = weights.z > 0.5 ? mix(flat_, lifted, 0.75) : flat_;
    bent = w[0] * n[0] + w[1] * n[1] + w[2] * n[2];
    number = w[0] * f[0] + w[1] * f[1] + w[2] * f[2];
    mark = w[0] * m[0] + w[1] * m[1] + w[2] * m[2];
  }
  if (shows == 1) number = texelFetch(numbers, at(cell), 0).x;
#ifdef SHADOW
  // Along the light onto the floor, a little above it.
  float above = dot(world - ground, floor_);
  world += (0.002 * lift - above) * fall / dot(fall, floor_);
#endif
  gl_Position = projectionMatrix * (viewMatrix * vec4(world, 1.0));
}
`;

const SHADE = `
precision highp float;
uniform float radius;
uniform vec3 middle;
in vec3 world;
out vec4 colour;
void main() {
  float presence = 1.0 - smoothstep(0.55, 1.0, distance(world, middle) / radius);
  colour = vec4(0.05, 0.08, 0.14, 0.16 * presence);
}
`;

const FRAGMENT = `
precision highp float;
precision highp int;
uniform mat4 viewMatrix;
uniform vec3 cameraPosition;
uniform bool isOrthographic;
uniform vec3 paint;
uniform bool isMarked;
uniform int shows;
uniform vec2 ends;
uniform sampler2D map;
uniform vec4 cut;      // normal and how far along it what is drawn ends
uniform float opacity;
uniform int chosen;
in vec3 world;
in vec3 bent;
in float number;
in vec3 mark;
flat in int cell;
out vec4 colour;
${LIGHT}
void main() {
  if (dot(world, cut.xyz) > cut.w) discard;
  vec3 back = vec3(viewMatrix[0].z, viewMatrix[1].z, viewMatrix[2].z);
  vec3 viewer = isOrthographic ? back : normalize(cameraPosition - world);
  vec3 skin = paint;
  if (shows != 0) {
    // What is no number is grey.
    bool known = number == number;
    float share = clamp((number - ends.x) / (ends.y - ends.x), 0.0, 1.0);
    skin = known ? texture(map, vec2((share * 63.0 + 0.5) / 64.0, 0.5)).rgb : vec3(0.69, 0.706, 0.729);
  }
  skin = toLinear(skin);
  if (isMarked && shows == 0) {
    // Plain and another tone in turn, in eighths of space around the cell at rest, as in pictures.
    vec3 side = clamp(mark / max(fwidth(mark), 1e-9), -1.0, 1.0);
    bool isPale = dot(skin, vec3(0.2126, 0.7152, 0.0722)) >= 0.5;
    skin = mix(skin, isPale ? 0.3 * skin : skin + 0.75 * (1.0 - skin), 0.5 - 0.5 * side.x * side.y * side.z);
  }
  vec3 normal = normalize(bent);
  // The outside faces the viewer where it lies on the side that is seen; gl_FrontFacing means another thing in each pass.
  bool isOutside = dot(cross(dFdx(world), dFdy(world)), normal) > 0.0;
  if (!isOutside) {
    if (cut.w < 1e29 && opacity >= 1.0) {
      // The inside of what is cut is flat and pale.
      colour = vec4(toScreen(0.35 + 0.65 * skin), 1.0);
      return;
    }
    normal = -normal;
  }
  float facing = dot(normal, viewer);
  if (facing < 0.05) normal = normalize(normal + (0.05 - facing) * viewer);
  // A thin skin seen edge on is looked through at a slant and hides more.
  float slant = 1.0 - clamp(facing, 0.0, 1.0);
  colour = vec4(lit(skin, normal, viewer), opacity + (1.0 - opacity) * slant * slant);
  if (!isOutside) colour.a *= opacity < 1.0 ? 0.4 : 1.0;
  if (cell == chosen) colour.rgb = mix(colour.rgb, vec3(1.0, 0.85, 0.1), 0.2 + 0.6 * pow(1.0 - clamp(facing, 0.0, 1.0), 2.0));
}
`;

const PICK = `
precision highp float;
precision highp int;
uniform vec4 cut;
in vec3 world;
flat in int cell;
out vec4 colour;
void main() {
  if (dot(world, cut.xyz) > cut.w) discard;
  int id = cell + 1;
  colour = vec4(float(id & 255), float((id >> 8) & 255), float((id >> 16) & 255), 255.0) / 255.0;
}
`;

/** A texture of rows of 2 048 numbers that holds at least so many. */
function texture(count, format, type, internal, Array, channels) {
  const rows = Math.max(1, Math.ceil(count / WIDE));
  const made = new THREE.DataTexture(new Array(WIDE * rows * channels), WIDE, rows, format, type);
  made.internalFormat = internal;
  made.minFilter = THREE.NearestFilter;
  made.magFilter = THREE.NearestFilter;
  made.unpackAlignment = 1;
  return made;
}

/** The cells of a scene. */
export class Cells {
  constructor(types) {
    this.types = types;
    this.group = new THREE.Group();
    this.hidden = new Set();
    this.capacity = 0;
    this.frame = undefined;
    this.isSmooth = true;
    const shared = {
      atoms: { value: null }, numbers: { value: null }, map: { value: null },
      low: { value: new THREE.Vector3() }, sides: { value: new THREE.Vector3(1, 1, 1) },
      shows: { value: 0 }, ends: { value: new THREE.Vector2(0, 1) }, cut: { value: new THREE.Vector4(0, 0, 0, 1e30) },
      opacity: { value: 1 }, chosen: { value: -1 },
      light: { value: new THREE.Vector3(0, 0, 1) }, sky: { value: new THREE.Vector3(0, 0, 1) },
    };
    this.shared = shared;
    this.meshes = types.map((type) => {
      const material = (fragmentShader, paint) => new THREE.RawShaderMaterial({
        glslVersion: THREE.GLSL3, vertexShader: VERTEX, fragmentShader, side: THREE.DoubleSide,
        uniforms: { ...shared, rings: { value: null }, cornersOf: { value: null }, restOf: { value: null }, isMarked: { value: false }, paint: { value: paint } },
      });
      const paint = new THREE.Vector3(...[1, 3, 5].map((at) => parseInt(type.colour.slice(at, at + 2), 16) / 255));
      const mesh = new THREE.Mesh(undefined, material(FRAGMENT, paint));
      mesh.frustumCulled = false;
      mesh.renderOrder = 1;
      mesh.visible = false;
      mesh.userData = { skin: mesh.material, pick: material(PICK, paint), shade: material(SHADE, paint) };
      this.group.add(mesh);
      return mesh;
    });
    // Where there is a floor cells stand on it: what they darken, each pixel once.
    this.shadows = new THREE.Group();
    this.floor = { ground: { value: new THREE.Vector3() }, floor_: { value: new THREE.Vector3(0, 0, 1) }, fall: { value: new THREE.Vector3(0, 0, -1) }, lift: { value: 1 }, radius: { value: 1 }, middle: { value: new THREE.Vector3() } };
    for (const mesh of this.meshes) {
      const { shade } = mesh.userData;
      Object.assign(shade.uniforms, this.floor);
      Object.assign(shade, {
        defines: { SHADOW: 1 }, transparent: true, depthWrite: false,
        stencilWrite: true, stencilFunc: THREE.EqualStencilFunc, stencilRef: 0, stencilZPass: THREE.IncrementStencilOp,
      });
      const shadow = new THREE.Mesh(mesh.geometry, shade);
      shadow.frustumCulled = false;
      shadow.renderOrder = -1;
      mesh.userData.shadow = shadow;
      this.shadows.add(shadow);
    }
    this.shadows.visible = false;
  }

  /** Paints cells of some types in two tones, so that they are seen to turn from where they are in a frame, the first of the result. */
  mark(kinds, frame) {
    [this.marked, this.rest] = [kinds, frame];
    this.meshes.forEach((mesh, kind) => {
      const isMarked = kinds.includes(kind) && frame.kinds.includes(kind);
      if (isMarked && !mesh.userData.rest) mesh.userData.rest = this.restOf(kind, frame);
      const { uniforms } = mesh.userData.skin;
      uniforms.isMarked.value = isMarked;
      uniforms.restOf.value = mesh.userData.rest ?? null;
    });
  }

  /** Where the atoms of the first cell of a type lie from their mean in a frame. */
  restOf(kind, frame) {
    const { atoms } = this.types[kind];
    let first = 0;
    for (let cell = 0; frame.kinds[cell] !== kind; cell += 1) first += this.types[frame.kinds[cell]].atoms;
    const found = Array.from({ length: atoms }, (_, atom) => position(frame, first + atom));
    const mean = [0, 1, 2].map((axis) => found.reduce((sum, at) => sum + at[axis], 0) / atoms);
    const rest = texture(atoms, THREE.RGBAFormat, THREE.FloatType, 'RGBA32F', Float32Array, 4);
    found.forEach((at, atom) => rest.image.data.set(at.map((part, axis) => part - mean[axis]), 4 * atom));
    rest.needsUpdate = true;
    return rest;
  }

  /** How much skins hide; what is seen through is drawn after all else, its far side before its near one. */
  hides(opacity) {
    this.shared.opacity.value = opacity;
    for (const { userData: { skin } } of this.meshes) Object.assign(skin, { transparent: opacity < 1, depthWrite: opacity >= 1, forceSinglePass: opacity >= 1 });
  }

  /** The links within cells, as lines. */
  links() {
    const all = [];
    for (let cell = 0; cell < this.frame.cells; cell += 1) {
      const first = this.firsts[cell];
      for (const [a, b] of this.hidden.has(this.kinds[cell]) ? [] : this.types[this.kinds[cell]].links) all.push(...position(this.frame, first + a), ...position(this.frame, first + b), 1);
    }
    return { count: all.length / 7, all: new Float32Array(all) };
  }

  /** A colour for each id, far from those of the ids before it. */
  colourByIds() {
    const turns = Array.from({ length: 64 }, (_, k) => new THREE.Color().setHSL((k * 0.618034) % 1, 0.55 + 0.25 * ((k >> 1) & 1), 0.45 + 0.12 * (k % 3), THREE.SRGBColorSpace));
    this.setMap(turns.map((colour) => colour.getHex(THREE.SRGBColorSpace)).map((hex) => [hex >> 16, (hex >> 8) & 255, hex & 255]));
    this.colour(Float32Array.from(this.frame.ids, (id) => id % 64), 'cells', [0, 63]);
  }

  /** Colours of a scale, in sRGB. */
  setMap(colours) {
    if (this.map === colours) return;
    this.map = colours;
    const bytes = new Uint8Array(colours.flatMap((colour) => [...colour, 255]));
    const map = new THREE.DataTexture(bytes, colours.length, 1, THREE.RGBAFormat, THREE.UnsignedByteType);
    map.minFilter = THREE.LinearFilter;
    map.magFilter = THREE.LinearFilter;
    map.needsUpdate = true;
    this.shared.map.value?.dispose();
    this.shared.map.value = map;
  }

  /** Where the cells are. */
  show(frame) {
    this.frame = frame;
    const { shared } = this;
    if (frame.atoms > this.capacity) {
      shared.atoms.value?.dispose();
      shared.numbers.value?.dispose();
      shared.atoms.value = texture(frame.atoms, THREE.RGBAIntegerFormat, THREE.UnsignedShortType, 'RGBA16UI', Uint16Array, 4);
      shared.numbers.value = texture(frame.atoms, THREE.RedFormat, THREE.FloatType, 'R32F', Float32Array, 1);
      this.capacity = shared.numbers.value.image.data.length;
    }
    const { data } = shared.atoms.value.image;
    const [x, y, z] = frame.parts;
    for (let atom = 0, to = 0; atom < frame.atoms; atom += 1, to += 4) {
      data[to] = x[atom];
      data[to + 1] = y[atom];
      data[to + 2] = z[atom];
    }
    shared.atoms.value.needsUpdate = true;
    shared.low.value.set(...frame.low);
    shared.sides.value.set(...frame.sides);
    this.place(frame);
  }

  /** Which cells there are, where that has changed. */
  place(frame) {
    const before = this.kinds;
    if (before && before.length === frame.cells && before.every((kind, cell) => kind === frame.kinds[cell])) return;
    this.kinds = frame.kinds.slice();
    this.firsts = new Uint32Array(frame.cells + 1);
    for (let cell = 0; cell < frame.cells; cell += 1) this.firsts[cell + 1] = this.firsts[cell] + this.types[frame.kinds[cell]].atoms;
    this.counts = this.types.map(() => 0);
    for (const kind of frame.kinds) this.counts[kind] += 1;
    this.meshes.forEach((mesh, kind) => {
      const count = this.counts[kind];
      mesh.userData.count = count;
      mesh.visible = count > 0 && !this.hidden.has(kind);
      mesh.userData.shadow.visible = mesh.visible;
      if (count === 0) return;
      if (!mesh.userData.made) this.make(mesh, kind, this.firsts[frame.kinds.indexOf(kind)]);
      const owner = new Float32Array(2 * count);
      for (let cell = 0, to = 0; cell < frame.cells; cell += 1) {
        if (frame.kinds[cell] === kind) {
          owner[to] = this.firsts[cell];
          owner[to + 1] = cell;
          to += 2;
        }
      }
      const made = this.refinement(mesh, this.types[kind].facets.length, frame.cells);
      const geometry = new THREE.InstancedBufferGeometry();
      geometry.setIndex(made.index);
      geometry.setAttribute('corners', made.corners);
      geometry.setAttribute('weights', made.weights);
      geometry.setAttribute('owner', new THREE.InstancedBufferAttribute(owner, 2));
      geometry.instanceCount = count;
      mesh.geometry.dispose();
      mesh.geometry = geometry;
      mesh.userData.shadow.geometry = geometry;
    });
    this.shade();
  }

  /** The mesh of a type, as its first cell has it, whose atoms begin here. */
  make(mesh, kind, first) {
    const made = meshOf(this.types[kind].facets, (atom) => position(this.frame, first + atom));
    const { corners, ring } = made;
    const rings = texture(ring.length, THREE.RedIntegerFormat, THREE.UnsignedIntType, 'R32UI', Uint32Array, 1);
    rings.image.data.set(ring);
    rings.needsUpdate = true;
    const cornersOf = texture(corners.length / 3, THREE.RGBAIntegerFormat, THREE.UnsignedIntType, 'RGBA32UI', Uint32Array, 4);
    for (let corner = 0; corner < corners.length / 3; corner += 1) cornersOf.image.data.set(corners.slice(3 * corner, 3 * corner + 3), 4 * corner);
    cornersOf.needsUpdate = true;
    mesh.userData.made = made;
    for (const { uniforms } of [mesh.userData.skin, mesh.userData.pick, mesh.userData.shade]) {
      uniforms.rings.value = rings;
      uniforms.cornersOf.value = cornersOf;
    }
  }

  /** The mesh with its edges in as many parts as so many cells allow. */
  refinement(mesh, facets, cells) {
    const parts = this.isSmooth ? partsFor(facets, cells) : 1;
    if (mesh.userData.parts !== parts) {
      const { ids, weights, index } = refined(mesh.userData.made, parts);
      mesh.userData.parts = parts;
      mesh.userData.refined = { corners: new THREE.BufferAttribute(ids, 3), weights: new THREE.BufferAttribute(weights, 3), index: new THREE.BufferAttribute(index, 1) };
    }
    return mesh.userData.refined;
  }

  /** Whether skins are bent between their atoms, or flat. */
  smooth(isSmooth) {
    if (isSmooth === this.isSmooth) return;
    this.isSmooth = isSmooth;
    this.kinds = undefined;
    if (this.frame) this.place(this.frame);
  }

  /** What colours show: numbers of cells or of atoms between these ends, or types where there are none. */
  colour(numbers, of, ends) {
    const { shared } = this;
    shared.shows.value = !numbers ? 0 : of === 'cells' ? 1 : 2;
    if (!numbers) return;
    shared.numbers.value.image.data.set(numbers.subarray(0, this.capacity));
    shared.numbers.value.needsUpdate = true;
    shared.ends.value.set(...ends);
  }

  /** Shadows cost as much as the cells: large scenes go without. */
  shade() {
    const drawn = this.meshes.reduce((sum, { userData }) => sum + (userData.count ?? 0) * (userData.refined?.index.count ?? 0) / 3, 0);
    this.shadows.visible = Boolean(this.standing) && drawn < 350_000;
  }

  /** A floor that cells darken: a point, its unit normal, and how far it is seen from there, µm; none without one. */
  stand(floor) {
    this.standing = floor;
    this.shade();
    if (!floor) return;
    const { ground, floor_, fall, lift, radius, middle } = this.floor;
    ground.value.copy(floor.point);
    middle.value.copy(floor.point);
    floor_.value.copy(floor.normal);
    // A light that stands high, a little to the left and before.
    fall.value.copy(floor.normal).multiplyScalar(-1).add(new THREE.Vector3(0.22, 0.14, 0)).normalize();
    lift.value = floor.radius;
    radius.value = floor.radius;
  }

  hide(kind, isHidden) {
    if (isHidden) this.hidden.add(kind);
    else this.hidden.delete(kind);
    const mesh = this.meshes[kind];
    mesh.visible = !isHidden && (this.counts?.[kind] ?? 0) > 0;
    mesh.userData.shadow.visible = mesh.visible;
  }

  /** Draws numbers of cells in place of colours while `work` runs. */
  picking(work) {
    for (const mesh of this.meshes) mesh.material = mesh.userData.pick;
    work();
    for (const mesh of this.meshes) mesh.material = mesh.userData.skin;
  }

  /** The mean of the atoms of a cell, µm. */
  centre(cell) {
    const sum = [0, 0, 0];
    const [first, end] = [this.firsts[cell], this.firsts[cell + 1]];
    for (let atom = first; atom < end; atom += 1) position(this.frame, atom).forEach((part, axis) => { sum[axis] += part; });
    return sum.map((part) => part / (end - first));
  }
}
