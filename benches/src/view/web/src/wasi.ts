// Runs a program for WASI (preview 1) without a system: files in memory, output as text. It has the
// calls that `sdop-live` makes; any other one fails with "not supported".

const SUCCESS = 0;
const BAD_FILE = 8;
const NO_ENTRY = 44;
const NOT_SUPPORTED = 52;
const ROOT = 3;

class Exit extends Error {
  constructor(readonly code: number) {
    super(`exit ${code}`);
  }
}

/** Files by their path without a leading slash. */
export type Files = Map<string, Uint8Array>;

/** The standard output of a program; an error has what it wrote to standard error. */
export async function run(module: WebAssembly.Module, args: string[], files: Files): Promise<string> {
  const written: Uint8Array[][] = [[], [], []];
  const opened = new Map<number, { bytes: Uint8Array; at: number }>();
  let memory: WebAssembly.Memory;
  const view = () => new DataView(memory.buffer);
  const bytes = (at: number, length: number) => new Uint8Array(memory.buffer, at, length);
  const put = (at: number, value: number) => (view().setUint32(at, value, true), SUCCESS);
  const argv = args.map((arg) => new TextEncoder().encode(`${arg}\0`));
  const total = argv.reduce((sum, arg) => sum + arg.length, 0);
  /** Calls `act` with each buffer of a list until it returns less than the buffer's length. */
  const each = (list: number, count: number, sum: number, act: (part: Uint8Array) => number): number => {
    let done = 0;
    for (let n = 0; n < count; n++) {
      const part = bytes(view().getUint32(list + 8 * n, true), view().getUint32(list + 8 * n + 4, true));
      const moved = act(part);
      done += moved;
      if (moved < part.length) break;
    }
    return put(sum, done);
  };
  const kind = (fd: number) => (fd === ROOT ? 3 : opened.has(fd) ? 4 : 2);
  const calls: Record<string, (...given: never[]) => number> = {
    args_sizes_get: (count: number, size: number) => put(count, argv.length) || put(size, total),
    args_get(list: number, at: number) {
      for (const [n, arg] of argv.entries()) {
        put(list + 4 * n, at);
        bytes(at, arg.length).set(arg);
        at += arg.length;
      }
      return SUCCESS;
    },
    environ_sizes_get: (count: number, size: number) => put(count, 0) || put(size, 0),
    environ_get: () => SUCCESS,
    clock_time_get(_id: number, _precision: bigint, at: number) {
      view().setBigUint64(at, BigInt(Math.round(performance.now() * 1e6)), true);
      return SUCCESS;
    },
    random_get(at: number, length: number) {
      crypto.getRandomValues(bytes(at, length));
      return SUCCESS;
    },
    fd_prestat_get: (fd: number, at: number) => (fd === ROOT ? put(at, 0) || put(at + 4, 1) : BAD_FILE),
    fd_prestat_dir_name: (_fd: number, at: number) => (bytes(at, 1).set([47]), SUCCESS),
    fd_fdstat_get(fd: number, at: number) {
      bytes(at, 24).fill(0);
      bytes(at, 1)[0] = kind(fd);
      bytes(at + 8, 16).fill(255); // all rights
      return SUCCESS;
    },
    fd_filestat_get(fd: number, at: number) {
      bytes(at, 64).fill(0);
      bytes(at + 16, 1)[0] = kind(fd);
      return put(at + 32, opened.get(fd)?.bytes.length ?? 0);
    },
    path_open(_fd: number, _follow: number, at: number, length: number, _flags: number, _a: bigint, _b: bigint, _c: number, out: number) {
      const file = files.get(new TextDecoder().decode(bytes(at, length)));
      if (!file) return NO_ENTRY;
      const fd = ROOT + 1 + opened.size;
      opened.set(fd, { bytes: file, at: 0 });
      return put(out, fd);
    },
    fd_read(fd: number, list: number, count: number, sum: number) {
      const file = opened.get(fd);
      if (!file) return BAD_FILE;
      return each(list, count, sum, (part) => {
        const read = file.bytes.subarray(file.at, file.at + part.length);
        part.set(read);
        file.at += read.length;
        return read.length;
      });
    },
    fd_write: (fd: number, list: number, count: number, sum: number) =>
      each(list, count, sum, (part) => written[fd].push(part.slice()) && part.length),
    fd_close: () => SUCCESS,
    proc_exit(code: number) {
      throw new Exit(code);
    },
  };
  const system = new Proxy(calls, { get: (all, name: string) => all[name] ?? (() => NOT_SUPPORTED) });
  const { exports } = await WebAssembly.instantiate(module, { wasi_snapshot_preview1: system as never });
  memory = exports.memory as WebAssembly.Memory;
  const text = async (fd: number) => new Blob(written[fd] as BlobPart[]).text();
  try {
    (exports._start as () => void)();
  } catch (error) {
    if (!(error instanceof Exit)) throw new Error((await text(2)) || String(error));
    if (error.code !== 0) throw new Error(await text(2));
  }
  return text(1);
}
