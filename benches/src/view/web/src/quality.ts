// How sharp and how fine to draw: everything while the picture rests, only what the machine manages while it moves.

export interface Quality {
  /** Pixels drawn per CSS pixel; two and more smooth the edges. */
  sharpness: number;
  /** Bodies are drawn as if so many times smaller. */
  coarseness: number;
}

/** From the finest to the cheapest. Factors of sharpness apply to the screen's own pixels, at most two per CSS pixel. */
const LADDER: Quality[] = [
  { sharpness: 2, coarseness: 0.4 },
  { sharpness: 1, coarseness: 1 },
  { sharpness: 1, coarseness: 2 },
  { sharpness: 0.7, coarseness: 2.5 },
  { sharpness: 0.5, coarseness: 4 },
  { sharpness: 0.4, coarseness: 8 },
];

/** The longest mean time between pictures that is smooth enough, in milliseconds. */
const SMOOTH = 26;

/** What nobody waits a whole window for, in milliseconds. */
const FAR_TOO_LONG = 4 * SMOOTH;

/** Times in a mean. */
const WINDOW = 6;

export class Pace {
  private level = 1;
  private times: number[] = [];

  /** What to draw with, now. Between pictures of one movement the time is measured. */
  at(now: number, moving: boolean): Quality {
    if (!moving) {
      this.times = [];
      return scaled(LADDER[0]);
    }
    this.times.push(now);
    const gaps = this.times.length - 1;
    const slow = gaps >= 2 && now - this.times[gaps - 2] > 2 * FAR_TOO_LONG;
    if (gaps === WINDOW || slow) {
      const mean = (now - this.times[0]) / gaps;
      // One step per doubling of the time.
      const steps = Math.ceil(Math.log2(mean / SMOOTH));
      if (steps > 0) this.level = Math.min(LADDER.length - 1, this.level + steps);
      this.times = steps > 0 ? [] : this.times.slice(1);
    }
    return scaled(LADDER[this.level]);
  }
}

function scaled({ sharpness, coarseness }: Quality): Quality {
  const pixels = Math.min(devicePixelRatio, 2);
  return { sharpness: Math.min(2, sharpness * pixels), coarseness };
}
