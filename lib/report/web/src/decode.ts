// Planes of the maps: zig-zag coded differences, u16 as all low bytes and then all high bytes.
import type { Plane } from './contract';

export type Values = Uint8Array | Uint16Array;

function decodeBytes(bytes: Uint8Array, start: number, count: number): Uint8Array {
  const values = new Uint8Array(count);
  let value = 0;
  for (let i = 0; i < count; ++i) {
    const code = bytes[start + i];
    value += (code >>> 1) ^ -(code & 1);
    values[i] = value; // modulo 2^8, and so is the next sum
  }
  return values;
}

function decodeWords(bytes: Uint8Array, start: number, count: number): Uint16Array {
  const values = new Uint16Array(count);
  const high = start + count;
  let value = 0;
  for (let i = 0; i < count; ++i) {
    const code = bytes[start + i] | (bytes[high + i] << 8);
    value = (value + ((code >>> 1) ^ -(code & 1))) & 0xffff;
    values[i] = value;
  }
  return values;
}

const bytesPerValue = { u8: 1, u16: 2 };

/** The planes of maps one after the other, by map and field. */
export function decodePlanes(
  bytes: Uint8Array,
  maps: { points: number; planes: Plane[] }[],
): Map<string, Values>[] {
  let wanted = 0;
  for (const { points, planes } of maps) {
    for (const plane of planes) wanted += points * bytesPerValue[plane.type];
  }
  if (bytes.length !== wanted) throw new Error(`${bytes.length} bytes of points where ${wanted} were expected`);
  let at = 0;
  return maps.map(({ points, planes }) => {
    const values = new Map<string, Values>();
    for (const { field, type } of planes) {
      values.set(field, (type === 'u8' ? decodeBytes : decodeWords)(bytes, at, points));
      at += points * bytesPerValue[type];
    }
    return values;
  });
}

export function bytesOfBase64(text: string): Uint8Array<ArrayBuffer> {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

export async function gunzip(bytes: Uint8Array<ArrayBuffer>): Promise<Uint8Array> {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}
