// The part of the page's address after #: frame, camera and switches, so that a link restores the
// view.

import { LAYERS, type Switches } from "./overlays.ts";

export interface Address {
  frame: number | null;
  /** The world's point in the middle, then camera and target in the picture's units. */
  origin: number[] | null;
  camera: number[] | null;
  switches: Switches | null;
  picked: number | null;
  /** Which strategy is shown, or both side by side. */
  sides: "first" | "second" | "both" | null;
  speed: number | null;
  /** Only the picture and its caption. */
  still: boolean;
}

const numbers = (text: string | null, count: number): number[] | null => {
  const list = text?.split(",").map(Number);
  return list?.length === count && list.every(Number.isFinite) ? list : null;
};

const whole = (text: string | null): number | null => (text !== null && /^\d+$/.test(text) ? Number(text) : null);

/** Reads an address. What can't be read is left out: an old link still opens the page. */
export function parse(hash: string): Address {
  const fields = new URLSearchParams(hash.replace(/^#/, ""));
  const show = fields.get("show");
  const on = show?.split(",");
  const sides = fields.get("sides");
  const speed = Number(fields.get("speed") ?? Number.NaN);
  return {
    frame: whole(fields.get("frame")),
    origin: numbers(fields.get("origin"), 3),
    camera: numbers(fields.get("camera"), 6),
    switches: on ? (Object.fromEntries(LAYERS.map((layer) => [layer, on.includes(layer)])) as Switches) : null,
    picked: whole(fields.get("body")),
    sides: sides === "first" || sides === "second" || sides === "both" ? sides : null,
    speed: Number.isFinite(speed) && speed > 0 ? speed : null,
    still: fields.has("still"),
  };
}

/** Writes an address; `parse` reads it back. */
export function format(address: Address): string {
  const fields: string[] = [];
  const put = (name: string, value: string | number | null) => {
    if (value !== null) fields.push(`${name}=${value}`);
  };
  const short = (list: number[] | null) => list && list.map((x) => Number(x.toPrecision(6))).join(",");
  put("frame", address.frame);
  put("origin", address.origin && address.origin.join(","));
  put("camera", short(address.camera));
  put("show", address.switches && (LAYERS.filter((layer) => address.switches![layer]).join(",") || "none"));
  put("body", address.picked);
  put("sides", address.sides);
  put("speed", address.speed);
  if (address.still) fields.push("still");
  return `#${fields.join("&")}`;
}
