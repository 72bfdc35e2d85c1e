// The page's data: a JSON header and blocks of numbers in base64, little endian, each in its own
// script element.
//
// `benches/src/view/page.rs` writes it; `format` and `version` say which layout. All poses are the
// record's f32 to the bit.

export const FORMAT = "sdop-view";
export const VERSION = 1;

export interface Lod {
  /** First vertex and number of vertices in the block `vertices`, three floats each. */
  vertices: [number, number];
  /**
   * First triangle and number of triangles in the block `triangles`, three vertex numbers each,
   * counted from the first vertex.
   */
  triangles: [number, number];
}

export interface ShapeHeader {
  name: string;
  /** Triangles as culled; the levels of detail have fewer. */
  triangles: number;
  /** Centre and radius in the body frame. */
  ball: [number, number, number, number];
  /** The largest vertex norm about the body's origin. */
  reach: number;
  ordop: { k: number; basis: number[]; lo: number[]; hi: number[] };
  /** The finest first. */
  lods: Lod[];
  /** First vertex and number of vertices in the block `hull`. */
  hull: [number, number];
}

/** One strategy on the frames. */
export interface RunHeader {
  name: string;
  detail: string;
  /** Whether the strategy culls nothing; then no pair counts as missed. */
  control: boolean;
  /** Volumes in the order of their tests, or null where the record has no counters. */
  volumes: string[] | null;
  /**
   * Co in seconds, or null where T is not known. The block `terms-…` has Nu·Cu, F and Nv·Cv per
   * frame.
   */
  construct: number | null;
}

export interface BlockHeader {
  name: string;
  type: "f32" | "f64" | "u8" | "u16" | "u32";
  length: number;
}

export interface Header {
  format: string;
  version: number;
  scene: string;
  source: string;
  seed: string | null;
  /** Seconds between frames. */
  dt: number | null;
  /** The side of the box about the origin that the bodies bounce in. */
  side: number | null;
  /** Bodies of interest to the strategy. */
  interest: number[];
  bodies: number;
  moving: number;
  frames: number;
  pairs: number;
  shapes: ShapeHeader[];
  runs: RunHeader[];
  /** Whether pairs are known to meet or not, in exact arithmetic. */
  truth: boolean;
  /** What the truth is about, such as meshes. */
  meet: string;
  /** Layers that are switched on at first. */
  layers: string[];
  effects: { name: string; on: boolean }[] | null;
  /**
   * The missed pair of a counter-example, by the frame's index, and a point that both bodies share
   * in it.
   */
  focus: { frame: number; bodies: [number, number]; point: [number, number, number] | null } | null;
  /** Messages from the reader of the record. */
  messages: string[];
  blocks: BlockHeader[];
}

export type Numbers = Float32Array | Float64Array | Uint8Array | Uint16Array | Uint32Array;

/** A pair's bits in the block `flags`; run r has the bit `REPORTED << r`. */
export const SPHERES = 1;
export const MEETS = 2;
export const REPORTED = 4;

export class DataError extends Error {}

const TYPES = {
  f32: Float32Array,
  f64: Float64Array,
  u8: Uint8Array,
  u16: Uint16Array,
  u32: Uint32Array,
} as const;

/** Bytes of base64 text. */
export function fromBase64(text: string): Uint8Array {
  const native = (Uint8Array as unknown as { fromBase64?: (text: string) => Uint8Array }).fromBase64;
  if (native) return native.call(Uint8Array, text);
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; i++) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

/** Decodes one block and checks it against its header. */
export function decodeBlock(block: BlockHeader, text: string): Numbers {
  const type = TYPES[block.type];
  if (!type) throw new DataError(`block ${block.name} has the unknown type ${block.type}`);
  let bytes: Uint8Array;
  try {
    bytes = fromBase64(text.trim());
  } catch {
    throw new DataError(`block ${block.name} is not base64: the page was cut off or changed`);
  }
  const expected = block.length * type.BYTES_PER_ELEMENT;
  if (bytes.length !== expected) {
    throw new DataError(`block ${block.name} has ${bytes.length} bytes, not ${expected}: the page was cut off or changed`);
  }
  return new type(bytes.buffer as ArrayBuffer, bytes.byteOffset, block.length);
}

/** Reads the header and rejects data that this page can't show. */
export function parseHeader(text: string): Header {
  let header: Header;
  try {
    header = JSON.parse(text) as Header;
  } catch (error) {
    throw new DataError(`the header is not JSON (${(error as Error).message}): the page was cut off or changed`);
  }
  if (header?.format !== FORMAT) throw new DataError("this page has no run");
  if (header.version !== VERSION) {
    throw new DataError(`the run has version ${header.version}, this viewer reads version ${VERSION}: write the page again with sdop view`);
  }
  return header;
}

/**
 * Takes header and blocks out of the document. The texts are removed: they are large and nobody
 * reads them again.
 */
export function readDocument(document: Document): { header: Header; blocks: Map<string, Numbers> } {
  const take = (id: string): string => {
    const element = document.getElementById(id);
    if (!element) throw new DataError(`${id} is missing: the page was cut off or changed`);
    const text = element.textContent ?? "";
    element.remove();
    return text;
  };
  const header = parseHeader(take("sdop-header"));
  const blocks = new Map<string, Numbers>();
  for (const block of header.blocks) blocks.set(block.name, decodeBlock(block, take(`block-${block.name}`)));
  return { header, blocks };
}
