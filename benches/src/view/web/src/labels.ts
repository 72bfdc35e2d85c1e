// Labels in the picture: which body is which, and where the two of a missed pair meet.

import { type PerspectiveCamera, Vector3 } from "three";

export interface Label {
  text: string;
  /** In the picture's units. */
  at: [number, number, number];
  /** A CSS colour. */
  colour: string;
}

export class Labels {
  constructor(private readonly place: HTMLElement) {}

  /** Shows these labels only, over a picture of this size, and none that is behind the camera. */
  show(labels: Label[], camera: PerspectiveCamera, width: number, height: number): void {
    const shown = labels.flatMap(({ text, at, colour }) => {
      const seen = new Vector3(...at).project(camera);
      if (Math.abs(seen.x) > 1 || Math.abs(seen.y) > 1 || Math.abs(seen.z) > 1) return [];
      const label = document.createElement("span");
      label.textContent = text;
      label.style.left = `${((seen.x + 1) / 2) * width}px`;
      label.style.top = `${((1 - seen.y) / 2) * height}px`;
      label.style.borderColor = colour;
      return [label];
    });
    this.place.replaceChildren(...shown);
  }
}
