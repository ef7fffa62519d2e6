// A part of what a page shows, as crates/io/src/export/html/part.rs writes it: a header of JSON and arrays of numbers, in one
// zlib stream. Surfaces are one part, their light another.

const MAGIC = "isoluxv1";

/** What the header says of an array. */
interface Section {
  type: "f32" | "f16" | "u32-delta" | "bytes";
  /** Bytes that belong together. They are stored byte by byte: the first bytes of all records, then the second ones. */
  record: number;
  offset: number;
  bytes: number;
  /** Factor of 16-bit floats. */
  scale?: number;
}

/** What this page was given cannot be read. */
export class Damaged extends Error {}

/** A part that was unpacked; H is what is in its header. */
export class Part<H> {
  readonly header: H;
  private readonly sections: Record<string, Section>;
  private readonly body: Uint8Array;

  /** Reads the bytes of an unpacked part. Throws Damaged if they are none. */
  constructor(bytes: Uint8Array) {
    const text = (from: number, to: number) => new TextDecoder().decode(bytes.subarray(from, to));
    if (bytes.length < 12 || text(0, 8) !== MAGIC) throw new Damaged("it is of another version of isolux");
    const length = new DataView(bytes.buffer, bytes.byteOffset + 8).getUint32(0, true);
    const header = JSON.parse(text(12, 12 + length));
    this.header = header;
    this.sections = header.sections;
    this.body = bytes.subarray(12 + length);
  }

  has(name: string): boolean {
    return name in this.sections;
  }

  /** An array of floats, 16 or 32 bits wide in the part. */
  floats(name: string): Float32Array {
    const section = this.section(name);
    const bytes = this.bytesOf(section);
    if (section.type === "f32") return new Float32Array(bytes.buffer);
    const halves = new Uint16Array(bytes.buffer);
    const values = halfValues();
    const scale = section.scale ?? 1;
    return Float32Array.from(halves, (half) => values[half]! * scale);
  }

  /** An array of whole numbers. */
  numbers(name: string): Uint32Array {
    const numbers = new Uint32Array(this.bytesOf(this.section(name)).buffer);
    for (let k = 1; k < numbers.length; k++) numbers[k]! += numbers[k - 1]!;
    return numbers;
  }

  /** A file. */
  file(name: string): Uint8Array<ArrayBuffer> {
    return this.bytesOf(this.section(name));
  }

  private section(name: string): Section {
    const section = this.sections[name];
    if (!section) throw new Damaged(`there is no '${name}' in it`);
    return section;
  }

  /** The bytes of a section in their own order. */
  private bytesOf({ record, offset, bytes }: Section): Uint8Array<ArrayBuffer> {
    const stored = this.body.subarray(offset, offset + bytes);
    if (stored.length !== bytes) throw new Damaged("it ends too early");
    const found = new Uint8Array(bytes);
    const count = bytes / record;
    for (let k = 0; k < record; k++) {
      for (let n = 0, to = k, from = k * count; n < count; n++, to += record, from++) found[to] = stored[from]!;
    }
    return found;
  }
}

/** Unpacks a part and reads it. Throws Damaged if that cannot be done. */
export async function unpack<H>(packed: Uint8Array<ArrayBuffer>): Promise<Part<H>> {
  try {
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Part(new Uint8Array(await new Response(stream).arrayBuffer()));
  } catch (error) {
    throw error instanceof Damaged ? error : new Damaged("its checksum is wrong");
  }
}

let halves: Float32Array | undefined;

/** The values of all 16-bit floats (IEEE 754 binary16). */
export function halfValues(): Float32Array {
  halves ??= Float32Array.from({ length: 1 << 16 }, (_, half) => {
    const sign = half >> 15 ? -1 : 1;
    const exponent = (half >> 10) & 31;
    const fraction = half & 1023;
    if (exponent === 31) return fraction ? NaN : sign * Infinity;
    return sign * (exponent === 0 ? fraction * 2 ** -24 : (1024 + fraction) * 2 ** (exponent - 25));
  });
  return halves;
}
