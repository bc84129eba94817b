// Where data come from: the program that serves the page, or the film in the page itself. Both answer the same requests.

const KEPT = 192 * 1024 * 1024;

/** A cache of answers by request, which forgets the oldest when it holds too many bytes. */
class Kept {
  constructor() {
    this.all = new Map();
    this.bytes = 0;
  }

  get(request) {
    const known = this.all.get(request);
    if (known) {
      this.all.delete(request);
      this.all.set(request, known);
    }
    return known;
  }

  set(request, answer) {
    this.all.set(request, answer);
    this.bytes += answer.byteLength;
    for (const [oldest, other] of this.all) {
      if (this.bytes <= KEPT || oldest === request) break;
      this.all.delete(oldest);
      this.bytes -= other.byteLength;
    }
  }
}

const encoded = (request) => request.split('/').map(encodeURIComponent).join('/');

/** Data that the program answers with. */
class Served {
  constructor() {
    this.kept = new Kept();
    this.asked = new Map();
    this.isServed = true;
  }

  /** The bytes of an answer; undefined where there is no such thing. */
  async bytes(request) {
    const known = this.kept.get(request);
    if (known) return known;
    if (!this.asked.has(request)) {
      const work = (async () => {
        const response = await fetch(`data/${encoded(request)}`);
        if (response.status === 404) return undefined;
        if (!response.ok) throw new Error((await response.text()).trim());
        const bytes = await response.arrayBuffer();
        if (/^(frame|values|field|lines)\//.test(request)) this.kept.set(request, bytes);
        return bytes;
      })();
      this.asked.set(request, work.finally(() => this.asked.delete(request)));
    }
    return this.asked.get(request);
  }

  async now() {
    const response = await fetch('now');
    return response.status === 200 ? response.arrayBuffer() : undefined;
  }

  want(wish) {
    return fetch(wish, { method: 'POST' });
  }

  /** Calls `tell` with what is new, for as long as the page is open; `lost` when the program has ended. */
  listen(tell, lost) {
    const events = new EventSource('events');
    events.onmessage = (event) => tell(JSON.parse(event.data));
    events.onerror = () => {
      if (events.readyState === EventSource.CLOSED || events.readyState === EventSource.CONNECTING) lost();
    };
  }
}

async function inflated(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Data that stand in the page: an index and the packed answers. */
class Film {
  /** Reads the length of the index, and in base 64 the index and the packed answers. */
  static async of(text) {
    const gap = text.indexOf(' ');
    const length = Number(text.slice(0, gap));
    const letters = atob(text.slice(gap + 1).trim());
    const all = new Uint8Array(letters.length);
    for (let at = 0; at < letters.length; at += 1) all[at] = letters.charCodeAt(at);
    const film = new Film();
    const index = JSON.parse(new TextDecoder().decode(await inflated(all.subarray(0, length))));
    film.index = new Map(index.map(([request, ...rest]) => [request, rest]));
    film.packed = all.subarray(length);
    film.kept = new Kept();
    film.asked = new Map();
    film.isServed = false;
    return film;
  }

  async bytes(request) {
    const known = this.kept.get(request);
    if (known) return known;
    const entry = this.index.get(request);
    if (!entry) return undefined;
    if (!this.asked.has(request)) this.asked.set(request, this.unpacked(request, entry).finally(() => this.asked.delete(request)));
    return this.asked.get(request);
  }

  async unpacked(request, [start, length, size, before]) {
    // A chain of differences begins at the last one that is known, or whole.
    const chain = [];
    let at = before;
    while (at && !this.kept.get(at)) {
      chain.push(at);
      at = this.index.get(at)[3];
    }
    for (const name of chain.reverse()) await this.one(name);
    return this.one(request);
  }

  async one(request) {
    const known = this.kept.get(request);
    if (known) return known;
    const [start, length, size, before] = this.index.get(request);
    const bytes = await inflated(this.packed.subarray(start, start + length));
    if (bytes.length !== size) throw new Error(`${request} is damaged`);
    let answer = bytes.buffer;
    if (before) {
      const then = new Uint16Array(this.kept.get(before) ?? await this.one(before));
      const now = new Uint16Array(size / 2);
      const half = size / 2;
      for (let k = 0; k < half; k += 1) now[k] = then[k] + (bytes[k] | (bytes[half + k] << 8));
      answer = now.buffer;
    }
    this.kept.set(request, answer);
    return answer;
  }
}

/** The source of this page. */
export async function openSource() {
  const film = document.getElementById('film');
  if (!film) return new Served();
  const text = film.textContent;
  film.remove();
  return Film.of(text);
}

/** An answer of JSON; undefined where there is no such thing. */
export async function json(source, request) {
  const bytes = await source.bytes(request);
  return bytes && JSON.parse(new TextDecoder().decode(bytes));
}

/** The cells of a frame and where their atoms are, from the bytes that the program packs (`src/view/pack.rs`). */
export function frameOf(bytes, offset = 0) {
  const buffer = offset ? bytes.slice(offset) : bytes;
  const view = new DataView(buffer);
  const [cells, atoms] = [view.getUint32(0, true), view.getUint32(4, true)];
  const three = (at) => [0, 1, 2].map((axis) => view.getFloat32(at + 4 * axis, true));
  const first = 32 + 12 * cells;
  const parts = [0, 1, 2].map((axis) => new Uint16Array(buffer, first + 2 * axis * atoms, atoms));
  return {
    cells,
    atoms,
    low: three(8),
    sides: three(20),
    ids: new Float64Array(buffer, 32, cells),
    kinds: new Uint32Array(buffer, 32 + 8 * cells, cells),
    parts,
  };
}

/** Where an atom of a frame is, µm. */
export function position(frame, atom) {
  return [0, 1, 2].map((axis) => frame.low[axis] + (frame.parts[axis][atom] / 65535) * frame.sides[axis]);
}

/** Lines with a number each: positions of both ends, and the numbers. */
export function linesOf(bytes) {
  const count = new DataView(bytes).getUint32(0, true);
  const all = new Float32Array(bytes, 4, 7 * count);
  return { count, all };
}

/** The values of a field: its ends and parts of 65 534 between them, 65 535 for none. */
export function fieldOf(bytes) {
  const view = new DataView(bytes);
  return { low: view.getFloat32(0, true), high: view.getFloat32(4, true), parts: new Uint16Array(bytes, 8) };
}
