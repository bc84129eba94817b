// What is around the cells: planes, tools, fields, and lines such as fibres, contacts and arrows.

import * as THREE from 'three';
import { LIGHT } from './light.js';

const vector = (parts) => new THREE.Vector3(...parts);

/** Two unit vectors across a third. */
function across(normal) {
  const first = Math.abs(normal.x) < 0.9 ? new THREE.Vector3(1, 0, 0) : new THREE.Vector3(0, 1, 0);
  const u = first.addScaledVector(normal, -first.dot(normal)).normalize();
  return [u, new THREE.Vector3().crossVectors(normal, u)];
}

/** A round number at least so large: 1, 2 or 5 of a power of ten. */
export function nice(least) {
  const power = 10 ** Math.floor(Math.log10(least));
  return [1, 2, 5, 10].map((by) => by * power).find((number) => number >= least * 0.999);
}

const GRID_VERTEX = `
precision highp float;
uniform mat4 modelViewMatrix, projectionMatrix;
in vec3 position;
out vec2 at;
void main() { at = position.xy; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }
`;
const GRID_FRAGMENT = `
precision highp float;
uniform float grid, radius;
uniform vec3 ground, lines;
uniform vec2 offset;
uniform bool isFloor;
in vec2 at;
out vec4 colour;
float line(vec2 p) {
  vec2 d = abs(fract(p - 0.5) - 0.5) / fwidth(p);
  return 1.0 - clamp(min(d.x, d.y), 0.0, 1.0);
}
void main() {
  float presence = isFloor ? 1.0 - smoothstep(0.55, 1.0, length(at) / radius) : 0.35;
  float strength = max(0.45 * line((at + offset) / grid), line((at + offset) / (5.0 * grid)));
  colour = vec4(mix(ground, lines, strength), presence * (isFloor ? 0.92 : max(0.35, strength)));
  if (colour.a < 0.01) discard;
}
`;

/** A plane as a floor with a grid, or as a pane. */
function planeOf(obstacle, box, dark) {
  const normal = vector(obstacle.normal).normalize();
  const [low, sides] = [vector(box.low), vector(box.sides)];
  const centre = low.clone().addScaledVector(sides, 0.5);
  const size = Math.max(sides.length(), 1e-6);
  const below = centre.clone().addScaledVector(normal, -centre.clone().sub(vector(obstacle.point)).dot(normal));
  const isFloor = normal.z > 0.7;
  const radius = (isFloor ? 2.2 : 0.6) * size;
  const [u, v] = across(normal);
  const grid = nice(0.04 * size);
  const material = new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3, vertexShader: GRID_VERTEX, fragmentShader: GRID_FRAGMENT, transparent: true, depthWrite: false, side: THREE.DoubleSide,
    uniforms: {
      grid: { value: grid }, radius: { value: radius }, isFloor: { value: isFloor },
      ground: { value: vector(dark ? [0.14, 0.16, 0.19] : [0.945, 0.952, 0.962]) },
      lines: { value: vector(dark ? [0.33, 0.37, 0.43] : [0.74, 0.77, 0.81]) },
      offset: { value: new THREE.Vector2(below.dot(u), below.dot(v)) },
    },
  });
  const mesh = new THREE.Mesh(new THREE.PlaneGeometry(2 * radius, 2 * radius), material);
  mesh.matrixAutoUpdate = false;
  mesh.matrix.makeBasis(u, v, normal).setPosition(below);
  mesh.renderOrder = -2;
  if (isFloor) mesh.userData.floor = { point: below, normal, radius };
  return mesh;
}

/** A body of revolution, as of glass. */
function toolOf(obstacle, light) {
  const axis = vector(obstacle.normal).normalize();
  const [u, v] = across(axis);
  const [parts, at, normals, index] = [96, [], [], []];
  const profile = obstacle.profile;
  const closes = profile[0][0] > 0 || profile[profile.length - 1][0] > 0;
  const sides = profile.slice(1).map((to, k) => [profile[k], to]);
  if (closes) sides.push([profile[profile.length - 1], profile[0]]);
  for (const [from, to] of sides) {
    const length = Math.hypot(to[0] - from[0], to[1] - from[1]);
    if (!length) continue;
    const first = at.length / 3;
    for (let part = 0; part <= parts; part += 1) {
      const angle = (2 * Math.PI * part) / parts;
      const out = u.clone().multiplyScalar(Math.cos(angle)).addScaledVector(v, Math.sin(angle));
      for (const [radius, height] of [from, to]) {
        at.push(...out.clone().multiplyScalar(radius).addScaledVector(axis, height).toArray());
        normals.push(...out.clone().multiplyScalar((to[1] - from[1]) / length).addScaledVector(axis, (from[0] - to[0]) / length).toArray());
      }
    }
    for (let part = 0; part < parts; part += 1) {
      const a = first + 2 * part;
      index.push(a, a + 2, a + 3, a, a + 3, a + 1);
    }
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(at, 3));
  geometry.setAttribute('normal', new THREE.Float32BufferAttribute(normals, 3));
  geometry.setIndex(index);
  const material = new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3, transparent: true, depthWrite: false, side: THREE.DoubleSide, uniforms: light,
    vertexShader: `precision highp float;
uniform mat4 modelMatrix, viewMatrix, projectionMatrix;
in vec3 position, normal;
out vec3 bent, world;
void main() { vec4 at = modelMatrix * vec4(position, 1.0); world = at.xyz; bent = normal; gl_Position = projectionMatrix * viewMatrix * at; }`,
    fragmentShader: `precision highp float;
uniform mat4 viewMatrix;
uniform vec3 cameraPosition;
uniform bool isOrthographic;
in vec3 bent, world;
out vec4 colour;
${LIGHT}
void main() {
  vec3 viewer = isOrthographic ? vec3(viewMatrix[0].z, viewMatrix[1].z, viewMatrix[2].z) : normalize(cameraPosition - world);
  vec3 normal = normalize(bent);
  if (dot(normal, viewer) < 0.0) normal = -normal;
  float slant = 1.0 - clamp(dot(normal, viewer), 0.0, 1.0);
  colour = vec4(lit(toLinear(vec3(0.56, 0.66, 0.74)), normal, viewer), 0.22 + 0.6 * slant * slant);
}`,
  });
  const mesh = new THREE.Mesh(geometry, material);
  mesh.frustumCulled = false;
  mesh.renderOrder = 3;
  return mesh;
}

/** Planes and tools. */
export class Obstacles {
  constructor(obstacles, box, light, dark) {
    this.group = new THREE.Group();
    this.obstacles = obstacles;
    this.meshes = obstacles.map((obstacle) => (obstacle.profile.length ? toolOf(obstacle, light) : planeOf(obstacle, box, dark)));
    this.meshes.forEach((mesh) => this.group.add(mesh));
    /** What cells stand on, of planes that look up the one that does most. */
    this.floor = this.meshes.map((mesh) => mesh.userData.floor).filter(Boolean).sort((one, other) => other.normal.z - one.normal.z)[0];
  }

  /** How far each has gone, µm. */
  move(gone) {
    this.obstacles.forEach((obstacle, number) => {
      if (obstacle.profile.length) this.meshes[number].position.copy(vector(obstacle.point)).add(vector(gone[number] ?? [0, 0, 0]));
    });
  }
}

/** A slice through a field, or a flat field as it lies. */
export class Slice {
  constructor(field) {
    this.field = field;
    this.isFlat = field.cells[2] === 1;
    this.axis = 2;
    this.share = this.isFlat ? 0.5 : 0.5;
    const texture = new THREE.Data3DTexture(new Uint16Array(field.cells[0] * field.cells[1] * field.cells[2]), ...field.cells);
    texture.format = THREE.RedIntegerFormat;
    texture.type = THREE.UnsignedShortType;
    texture.internalFormat = 'R16UI';
    texture.unpackAlignment = 1;
    this.texture = texture;
    this.material = new THREE.RawShaderMaterial({
      glslVersion: THREE.GLSL3, side: THREE.DoubleSide, transparent: true,
      uniforms: {
        values: { value: texture }, map: { value: null }, ends: { value: new THREE.Vector2(0, 1) }, scale: { value: new THREE.Vector2(0, 1) },
        cells: { value: vector(field.cells) }, alpha: { value: 1 }, isLog: { value: false },
      },
      vertexShader: `precision highp float;
uniform mat4 modelViewMatrix, projectionMatrix;
in vec3 position, share;
out vec3 at;
void main() { at = share; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }`,
      fragmentShader: `precision highp float;
precision highp int;
precision highp usampler3D;
uniform usampler3D values;
uniform sampler2D map;
uniform vec2 ends, scale;
uniform vec3 cells;
uniform float alpha;
uniform bool isLog;
in vec3 at;
out vec4 colour;
float value(ivec3 p) { return float(texelFetch(values, clamp(p, ivec3(0), ivec3(cells) - 1), 0).x); }
void main() {
  // Between the middles of boxes values are linear.
  vec3 p = at * cells - 0.5;
  ivec3 base = ivec3(floor(p));
  vec3 f = p - vec3(base);
  float sum = 0.0;
  for (int k = 0; k < 8; k++) {
    ivec3 near = ivec3(k & 1, (k >> 1) & 1, k >> 2);
    vec3 w = mix(1.0 - f, f, vec3(near));
    sum += w.x * w.y * w.z * value(base + near);
  }
  float found = scale.x + sum / 65534.0 * (scale.y - scale.x);
  float share = isLog ? log(max(found, 1e-30) / ends.x) / log(ends.y / ends.x) : (found - ends.x) / max(ends.y - ends.x, 1e-30);
  colour = vec4(texture(map, vec2((clamp(share, 0.0, 1.0) * 63.0 + 0.5) / 64.0, 0.5)).rgb, alpha);
}`,
    });
    this.mesh = new THREE.Mesh(new THREE.BufferGeometry(), this.material);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = -1;
    this.put();
  }

  /** Puts the slice across an axis at a share of the box. */
  put(axis = this.axis, share = this.share) {
    [this.axis, this.share] = [axis, share];
    const { cells, spacing, origin } = this.field;
    const [one, other] = [(axis + 1) % 3, (axis + 2) % 3];
    const [at, shares] = [[], []];
    for (const [a, b] of [[0, 0], [1, 0], [1, 1], [0, 1]]) {
      const corner = [0, 0, 0];
      corner[axis] = share;
      corner[one] = a;
      corner[other] = b;
      shares.push(...corner);
      const level = (part, k) => (this.isFlat && k === 2 ? origin[2] : origin[k] + part * cells[k] * spacing[k]);
      at.push(...corner.map(level));
    }
    const { geometry } = this.mesh;
    geometry.setAttribute('position', new THREE.Float32BufferAttribute(at, 3));
    geometry.setAttribute('share', new THREE.Float32BufferAttribute(shares, 3));
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
  }

  /** Where the slice is, µm. */
  level() {
    const { cells, spacing, origin } = this.field;
    return origin[this.axis] + this.share * cells[this.axis] * spacing[this.axis];
  }

  show({ low, high, parts }, ends) {
    this.texture.image.data.set(parts);
    this.texture.needsUpdate = true;
    const { uniforms } = this.material;
    uniforms.scale.value.set(low, high);
    uniforms.ends.value.set(...ends);
  }

  dispose() {
    this.texture.dispose();
    this.material.dispose();
    this.mesh.geometry.dispose();
  }
}

const LINES_VERTEX = `
precision highp float;
uniform mat4 viewMatrix, projectionMatrix;
uniform vec2 screen;
uniform float width, strongest;
uniform bool isArrow;
in vec3 position; // along, across, 1 for the head
in vec3 from, to;
in float size;
out float lift;
void main() {
  vec4 a = projectionMatrix * viewMatrix * vec4(from, 1.0), b = projectionMatrix * viewMatrix * vec4(to, 1.0);
  vec2 p = a.xy / a.w * screen, q = b.xy / b.w * screen;
  float length_ = max(distance(p, q), 1e-3);
  vec2 along = (q - p) / length_, side = vec2(-along.y, along.x);
  float thick = width * (strongest > 0.0 ? 0.4 + 0.6 * sqrt(clamp(size / strongest, 0.0, 1.0)) : 1.0);
  float head = isArrow ? min(4.5 * thick, 0.6 * length_) : 0.0;
  vec2 at = position.z > 0.5 ? q - along * head * (1.0 - position.x) + side * position.y * head * 0.45 * (1.0 - position.x)
                             : mix(p, q - along * head * 0.9, position.x) + side * position.y * 0.5 * thick;
  vec4 end = mix(a, b, position.z > 0.5 ? 1.0 : position.x);
  lift = position.y;
  gl_Position = vec4(at / screen * end.w, end.z, end.w);
}
`;
const LINES_FRAGMENT = `
precision highp float;
uniform vec3 paint;
in float lift;
out vec4 colour;
void main() { colour = vec4(paint * (1.0 - 0.25 * abs(lift)), 1.0); }
`;

const KINDS = {
  fibres: { paint: [0.66, 0.11, 0.18], width: 4, isArrow: false },
  links: { paint: [0.23, 0.25, 0.29], width: 2.5, isArrow: false },
  linked: { paint: [0.23, 0.25, 0.29], width: 5, isArrow: false },
  contacts: { paint: [0.2, 0.23, 0.28], width: 2, isArrow: false },
  traction: { paint: [0.84, 0.37, 0.0], width: 2.2, isArrow: true },
  loads: { paint: [0.23, 0.25, 0.29], width: 3, isArrow: true },
  tails: { paint: [0.35, 0.4, 0.48], width: 1.6, isArrow: false },
};

/** Lines of one kind, as wide on the screen from near and far. */
export class Lines {
  constructor(kind, screen) {
    const { paint, width, isArrow } = KINDS[kind];
    this.geometry = new THREE.InstancedBufferGeometry();
    const shaft = [[0, -1, 0], [1, -1, 0], [1, 1, 0], [0, 1, 0]];
    const head = [[0, -1, 1], [1, 0, 1], [0, 1, 1]];
    this.geometry.setAttribute('position', new THREE.Float32BufferAttribute([...shaft, ...(isArrow ? head : [])].flat(), 3));
    this.geometry.setIndex([0, 1, 2, 0, 2, 3, ...(isArrow ? [4, 5, 6] : [])]);
    this.geometry.instanceCount = 0;
    this.material = new THREE.RawShaderMaterial({
      glslVersion: THREE.GLSL3, vertexShader: LINES_VERTEX, fragmentShader: LINES_FRAGMENT, side: THREE.DoubleSide,
      // Contacts, links between cells and tails are seen through the cells.
      depthTest: kind !== 'contacts' && kind !== 'linked',
      uniforms: { screen, width: { value: width }, paint: { value: vector(paint) }, isArrow: { value: isArrow }, strongest: { value: 0 } },
    });
    this.mesh = new THREE.Mesh(this.geometry, this.material);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 2;
    this.scales = ['fibres', 'contacts', 'linked'].includes(kind);
  }

  show({ count, all }) {
    const buffer = new THREE.InstancedInterleavedBuffer(all, 7);
    this.geometry.setAttribute('from', new THREE.InterleavedBufferAttribute(buffer, 3, 0));
    this.geometry.setAttribute('to', new THREE.InterleavedBufferAttribute(buffer, 3, 3));
    this.geometry.setAttribute('size', new THREE.InterleavedBufferAttribute(buffer, 1, 6));
    this.geometry.instanceCount = count;
    let strongest = 0;
    for (let line = 0; line < count; line += 1) strongest = Math.max(strongest, all[7 * line + 6]);
    this.material.uniforms.strongest.value = this.scales ? strongest : 0;
    this.mesh.visible = count > 0;
  }
}
