// The polytope of an or-DOP, for drawing: corners and edges of the slabs lo ≤ d·x ≤ hi.
//
// Every corner lies on three planes. Therefore all triples of the k ≤ 26 planes are solved, and the
// points that no slab excludes are kept. An edge joins corners that share two planes. It computes
// in f64 with a tolerance, because it only draws and decides nothing.

export type Vec = [number, number, number];

const AXES: Vec[] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
const FACE_DIAGONALS: Vec[] = [[1, 1, 0], [1, -1, 0], [1, 0, 1], [1, 0, -1], [0, 1, 1], [0, 1, -1]];
const CUBE_DIAGONALS: Vec[] = [[1, 1, 1], [-1, 1, 1], [1, -1, 1], [-1, -1, 1]];

/** The coefficients of the slab directions over the basis, in the order of the record's slabs. */
export function coefficients(k: number): Vec[] {
  switch (k) {
    case 6:
      return AXES;
    case 14:
      return [...AXES, ...CUBE_DIAGONALS];
    case 18:
      return [...AXES, ...FACE_DIAGONALS];
    case 26:
      return [...AXES, ...FACE_DIAGONALS, ...CUBE_DIAGONALS];
    default:
      throw new RangeError(`no or-DOP has k = ${k}`);
  }
}

export interface Polytope {
  corners: Vec[];
  /** Pairs of corners. */
  edges: [number, number][];
}

interface Plane {
  normal: Vec;
  offset: number;
}

const dot = (a: Vec, b: Vec): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a: Vec, b: Vec): Vec => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/** The half-spaces normal·x ≤ offset, with unit normals. `basis` is three vectors in a row. */
export function halfSpaces(k: number, basis: number[], lo: number[], hi: number[]): Plane[] {
  return coefficients(k).flatMap(([a, b, c], slab) => {
    const d = [0, 1, 2].map((axis) => a * basis[axis] + b * basis[3 + axis] + c * basis[6 + axis]) as Vec;
    const length = Math.sqrt(dot(d, d));
    const normal = d.map((x) => x / length) as Vec;
    return [
      { normal, offset: hi[slab] / length },
      { normal: normal.map((x) => -x) as Vec, offset: -lo[slab] / length },
    ];
  });
}

/** The polytope of these half-spaces; `size` is about its radius and sets the tolerance. */
export function polytope(planes: Plane[], size: number): Polytope {
  const near = 1e-6 * size;
  const corners: Vec[] = [];
  const inside = (x: Vec) => planes.every((plane) => dot(plane.normal, x) <= plane.offset + near);
  const known = (x: Vec) => corners.some((corner) => corner.every((c, axis) => Math.abs(c - x[axis]) <= 4 * near));
  for (let a = 0; a < planes.length; a++) {
    for (let b = a + 1; b < planes.length; b++) {
      const along = cross(planes[a].normal, planes[b].normal);
      if (dot(along, along) < 1e-12) continue;
      for (let c = b + 1; c < planes.length; c++) {
        const x = meet(planes[a], planes[b], planes[c], along);
        if (x && inside(x) && !known(x)) corners.push(x);
      }
    }
  }
  return { corners, edges: edges(planes, corners, 8 * near) };
}

/** The point on three planes; `along` is the cross product of the first two normals. */
function meet(a: Plane, b: Plane, c: Plane, along: Vec): Vec | null {
  const volume = dot(along, c.normal);
  if (Math.abs(volume) < 1e-9) return null;
  const [bc, ca] = [cross(b.normal, c.normal), cross(c.normal, a.normal)];
  return [0, 1, 2].map((x) => (a.offset * bc[x] + b.offset * ca[x] + c.offset * along[x]) / volume) as Vec;
}

function edges(planes: Plane[], corners: Vec[], near: number): [number, number][] {
  const touched = corners.map((x) => planes.map((plane) => Math.abs(dot(plane.normal, x) - plane.offset) <= near));
  const list: [number, number][] = [];
  for (let i = 0; i < corners.length; i++) {
    for (let j = i + 1; j < corners.length; j++) {
      const shared = planes.filter((_, p) => touched[i][p] && touched[j][p]);
      // Two parallel planes, a flat body's, make no edge: their normals must differ.
      if (shared.some((plane) => Math.abs(dot(plane.normal, shared[0].normal)) < 1 - 1e-9)) list.push([i, j]);
    }
  }
  return list;
}
