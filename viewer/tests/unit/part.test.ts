import { deflateSync } from "node:zlib";
import { describe, expect, test } from "vitest";
import { fromBase64 } from "../../src/embedded";
import { Damaged, halfValues, Part, unpack } from "../../src/part";

/** Bytes of a part with the given sections, each stored byte by byte as part.rs does it. */
function bytesOf(sections: Record<string, { type: string; record: number; bytes: Uint8Array; scale?: number }>): Uint8Array<ArrayBuffer> {
  const header: Record<string, object> = {};
  const body: number[] = [];
  for (const [name, { type, record, bytes, scale }] of Object.entries(sections)) {
    header[name] = { type, record, offset: body.length, bytes: bytes.length, scale };
    for (let k = 0; k < record; k++) body.push(...bytes.filter((_, n) => n % record === k));
  }
  const text = new TextEncoder().encode(JSON.stringify({ name: "größe", sections: header }));
  const length = new Uint8Array(Uint32Array.of(text.length).buffer);
  return Uint8Array.from([...new TextEncoder().encode("isoluxv1"), ...length, ...text, ...body]);
}

const bytes = (array: Float32Array | Uint16Array | Uint32Array) => new Uint8Array(array.buffer);

describe("a part", () => {
  const whole = bytesOf({
    floats: { type: "f32", record: 8, bytes: bytes(Float32Array.of(1, -2.5, 3e30, 4)) },
    halves: { type: "f16", record: 2, bytes: bytes(Uint16Array.of(0x3c00, 0xc000, 0x7e00)), scale: 10 },
    numbers: { type: "u32-delta", record: 4, bytes: bytes(Uint32Array.of(5, 2, 0xffffffff, 70000)) },
    file: { type: "bytes", record: 1, bytes: Uint8Array.of(9, 8, 7) },
  });

  test("gives back what was put into it", async () => {
    const part = await unpack<{ name: string }>(new Uint8Array(deflateSync(whole)));
    expect(part.header.name).toBe("größe");
    expect([...part.floats("floats")]).toEqual([1, -2.5, Math.fround(3e30), 4]);
    expect([...part.floats("halves")]).toEqual([10, -20, NaN]);
    expect([...part.numbers("numbers")]).toEqual([5, 7, 6, 70006]);
    expect([...part.file("file")]).toEqual([9, 8, 7]);
    expect([part.has("file"), part.has("none")]).toEqual([true, false]);
  });

  test("that is damaged says so", async () => {
    const packed = new Uint8Array(deflateSync(whole));
    packed[packed.length - 1]! ^= 1;
    await expect(unpack(packed)).rejects.toThrow(Damaged);
    await expect(unpack(new Uint8Array(deflateSync(whole.subarray(0, 9))))).rejects.toThrow(Damaged);
    expect(() => new Part(whole).file("none")).toThrow("'none'");
    expect(() => new Part(whole.subarray(0, whole.length - 1)).file("file")).toThrow("too early");
    expect(() => fromBase64("a!c=")).toThrow(Damaged);
  });
});

test("halves are those of IEEE 754", () => {
  const values = halfValues();
  const known: [number, number][] = [[0, 0], [1, 2 ** -24], [0x0400, 2 ** -14], [0x3555, 0.333251953125], [0x7bff, 65504], [0x7c00, Infinity], [0xfbff, -65504]];
  for (const [half, value] of known) expect(values[half]).toBe(value);
  expect(values[0x7c01]).toBeNaN();
});

test("base64 is decoded in chunks", () => {
  const long = Uint8Array.from({ length: 3_000_001 }, (_, k) => (k * 7) & 255);
  const text = Buffer.from(long).toString("base64");
  expect(Buffer.compare(Buffer.from(fromBase64(text)), Buffer.from(long))).toBe(0);
});
