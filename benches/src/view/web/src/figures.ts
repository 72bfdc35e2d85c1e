// Wire figures and turns: plain geometry in f64.

export type Triple = [number, number, number];

/** A unit quaternion (x, y, z, w). */
export type Turn = [number, number, number, number];

export const UPRIGHT: Turn = [0, 0, 0, 1];

export const plus = (a: Triple, b: Triple): Triple => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];

/** The rotation that turns the first axis to a direction of this length. */
export function turnFromX(to: Triple, length: number): Turn {
  if (length === 0) return UPRIGHT;
  const [x, y, z] = to.map((c) => c / length);
  if (x < -0.999999) return [0, 1, 0, 0];
  const norm = Math.sqrt(2 * (1 + x));
  return [0, -z / norm, y / norm, norm / 2];
}

/** The vector turned and scaled. */
export function rotate([x, y, z, w]: Turn, v: Triple, scale: number): Triple {
  const [a, b, c] = [y * v[2] - z * v[1] + w * v[0], z * v[0] - x * v[2] + w * v[1], x * v[1] - y * v[0] + w * v[2]];
  return [
    scale * (v[0] + 2 * (y * c - z * b)),
    scale * (v[1] + 2 * (z * a - x * c)),
    scale * (v[2] + 2 * (x * b - y * a)),
  ];
}

/**
 * The world-aligned extent of turned points, relative to the body's origin, in the world's units.
 */
export function extent(points: Float64Array, turn: Turn): { low: Triple; high: Triple } {
  const rows = [rotate(turn, [1, 0, 0], 1), rotate(turn, [0, 1, 0], 1), rotate(turn, [0, 0, 1], 1)];
  const low: Triple = [Infinity, Infinity, Infinity];
  const high: Triple = [-Infinity, -Infinity, -Infinity];
  for (let p = 0; p < points.length; p += 3) {
    for (let axis = 0; axis < 3; axis++) {
      const x = rows[0][axis] * points[p] + rows[1][axis] * points[p + 1] + rows[2][axis] * points[p + 2];
      if (x < low[axis]) low[axis] = x;
      if (x > high[axis]) high[axis] = x;
    }
  }
  return { low, high };
}

/** Three great circles of the unit sphere. */
export function sphereLines(steps = 28): number[] {
  const lines: number[] = [];
  for (let axis = 0; axis < 3; axis++) {
    for (let s = 0; s < steps; s++) {
      for (const angle of [(2 * Math.PI * s) / steps, (2 * Math.PI * (s + 1)) / steps]) {
        const point = [0, 0, 0];
        point[(axis + 1) % 3] = Math.cos(angle);
        point[(axis + 2) % 3] = Math.sin(angle);
        lines.push(...point);
      }
    }
  }
  return lines;
}

/** The edges of the cube from −1 to 1. */
export function cubeLines(): number[] {
  const lines: number[] = [];
  for (let axis = 0; axis < 3; axis++) {
    for (const u of [-1, 1]) {
      for (const v of [-1, 1]) {
        for (const w of [-1, 1]) {
          const point = [0, 0, 0];
          point[axis] = w;
          point[(axis + 1) % 3] = u;
          point[(axis + 2) % 3] = v;
          lines.push(...point);
        }
      }
    }
  }
  return lines;
}
