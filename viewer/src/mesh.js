// The mesh of a type of cells as it is drawn: corners with rings of neighbours, from which the shader finds normals.

const SHARP = Math.cos((50 * Math.PI) / 180);

const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => {
  const size = Math.hypot(...a) || 1;
  return a.map((part) => part / size);
};

/**
 * Corners of facets, of which those of one atom are one where no sharp edge parts them, the facets by these corners, and for each corner
 * its neighbours in order. `at` says where atoms are where the mesh is first seen: edges that are sharp there stay edges.
 */
export function meshOf(facets, at) {
  const normals = facets.map(([a, b, c]) => unit(cross(minus(at(b), at(a)), minus(at(c), at(a)))));
  const key = (from, to) => from * 2 ** 26 + to;
  const owner = new Map();
  facets.forEach((facet, number) => facet.forEach((from, k) => owner.set(key(from, facet[(k + 1) % 3]), number)));
  const isSmooth = (from, to) => {
    const [one, other] = [owner.get(key(from, to)), owner.get(key(to, from))];
    if (one === undefined || other === undefined) return false;
    return normals[one].reduce((sum, part, axis) => sum + part * normals[other][axis], 0) > SHARP;
  };
  const around = new Map();
  facets.forEach((facet, number) => facet.forEach((atom, k) => {
    if (!around.has(atom)) around.set(atom, []);
    around.get(atom).push({ number, k, next: facet[(k + 1) % 3], last: facet[(k + 2) % 3] });
  }));
  const corners = [];
  const ring = [];
  const index = new Uint32Array(3 * facets.length);
  for (const [atom, fan] of around) {
    const byNext = new Map(fan.map((facet) => [facet.next, facet]));
    const left = new Set(fan);
    const walk = (start) => {
      const number = corners.length / 3;
      corners.push(atom, ring.length, 0);
      ring.push(start.next);
      let facet = start;
      while (facet && left.has(facet)) {
        left.delete(facet);
        index[3 * facet.number + facet.k] = number;
        ring.push(facet.last);
        facet = isSmooth(atom, facet.last) ? byNext.get(facet.last) : undefined;
      }
      corners[3 * number + 2] = ring.length - corners[3 * number + 1];
    };
    // Fans that begin at a sharp edge or at a rim come first; what is left goes all round.
    for (const facet of fan) if (left.has(facet) && !isSmooth(atom, facet.next)) walk(facet);
    for (const facet of fan) if (left.has(facet)) walk(facet);
  }
  return { corners, ring, index, isSmooth };
}

/** Triangles that a scene may have in all. */
const MOST = 700_000;

/** Parts that edges are drawn in: more the coarser the mesh is and the fewer cells there are. */
export function partsFor(facets, cells) {
  const fit = (parts) => facets * parts * parts * cells <= MOST;
  return [4, 3, 2].find((parts) => facets * parts * parts <= 1500 && fit(parts)) ?? 1;
}

/**
 * A mesh whose edges are in parts: of each vertex three corners and its weights (the first is what the others leave), and whether it may leave
 * the flat facet. Vertices on smooth edges belong to both facets; those on sharp edges stay on them.
 */
export function refined({ corners, index, isSmooth }, parts) {
  const [ids, weights, faces] = [[], [], []];
  const known = new Map();
  const add = (three, b, c, bends) => {
    ids.push(...three);
    weights.push(b, c, bends ? 1 : 0);
    return ids.length / 3 - 1;
  };
  const corner = (id) => {
    if (!known.has(id)) known.set(id, add([id, id, id], 0, 0, false));
    return known.get(id);
  };
  const onEdge = (from, to, part) => {
    // The same vertex from both sides.
    const [one, other, at] = from < to ? [from, to, part] : [to, from, parts - part];
    const key = `${one} ${other} ${at}`;
    if (!known.has(key)) known.set(key, add([one, other, other], at / parts, 0, isSmooth(corners[3 * one], corners[3 * other])));
    return known.get(key);
  };
  for (let facet = 0; facet < index.length; facet += 3) {
    const three = [...index.subarray(facet, facet + 3)];
    const [a, b, c] = three;
    // Vertex at b/parts along the first and c/parts along the second side.
    const grid = [];
    for (let j = 0; j <= parts; j += 1) {
      for (let k = 0; j + k <= parts; k += 1) {
        let vertex;
        const i = parts - j - k;
        if (i === parts) vertex = corner(a);
        else if (j === parts) vertex = corner(b);
        else if (k === parts) vertex = corner(c);
        else if (k === 0) vertex = onEdge(a, b, j);
        else if (i === 0) vertex = onEdge(b, c, k);
        else if (j === 0) vertex = onEdge(c, a, i);
        else vertex = add(three, j / parts, k / parts, true);
        grid[j * (parts + 1) + k] = vertex;
      }
    }
    const at = (j, k) => grid[j * (parts + 1) + k];
    for (let j = 0; j < parts; j += 1) {
      for (let k = 0; j + k < parts; k += 1) {
        faces.push(at(j, k), at(j + 1, k), at(j, k + 1));
        if (j + k < parts - 1) faces.push(at(j + 1, k), at(j + 1, k + 1), at(j, k + 1));
      }
    }
  }
  return { ids: new Float32Array(ids), weights: new Float32Array(weights), index: new Uint32Array(faces) };
}
