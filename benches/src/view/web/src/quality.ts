// How sharp and how fine to draw: full quality at rest, and what the machine can draw in time while
// the picture moves.

export interface Quality {
  /** Pixels drawn per CSS pixel; two and more smooth the edges. */
  sharpness: number;
  /** Bodies are drawn with the detail of bodies this many times smaller. */
  coarseness: number;
}

/**
 * From the finest to the cheapest. Factors of sharpness apply to the screen's own pixels, at most
 * two per CSS pixel.
 */
const LEVELS: Quality[] = [
  { sharpness: 2, coarseness: 0.4 },
  { sharpness: 1, coarseness: 1 },
  { sharpness: 1, coarseness: 2 },
  { sharpness: 0.7, coarseness: 2.5 },
  { sharpness: 0.5, coarseness: 4 },
  { sharpness: 0.4, coarseness: 8 },
];

/** The longest mean time between pictures that is smooth enough. */
const SMOOTH_MS = 26;

/** A time between pictures that lowers the quality before a whole window is measured. */
const MUCH_TOO_SLOW_MS = 4 * SMOOTH_MS;

/** The number of times that are averaged. */
const WINDOW = 6;

export class Pace {
  private level = 1;
  private times: number[] = [];

  /** The quality of the picture at `now`. Measures the time between pictures of a movement. */
  at(now: number, moving: boolean): Quality {
    if (!moving) {
      this.times = [];
      return scaled(LEVELS[0]);
    }
    this.times.push(now);
    const gaps = this.times.length - 1;
    const slow = gaps >= 2 && now - this.times[gaps - 2] > 2 * MUCH_TOO_SLOW_MS;
    if (gaps === WINDOW || slow) {
      const mean = (now - this.times[0]) / gaps;
      // One step per doubling of the time.
      const steps = Math.ceil(Math.log2(mean / SMOOTH_MS));
      if (steps > 0) this.level = Math.min(LEVELS.length - 1, this.level + steps);
      this.times = steps > 0 ? [] : this.times.slice(1);
    }
    return scaled(LEVELS[this.level]);
  }
}

function scaled({ sharpness, coarseness }: Quality): Quality {
  const pixels = Math.min(devicePixelRatio, 2);
  return { sharpness: Math.min(2, sharpness * pixels), coarseness };
}
