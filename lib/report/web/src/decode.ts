// Planes of the maps: zig-zag coded differences, one run for each byte of a value, low bytes first.
import type { Plane } from './contract';

export type Values = Uint8Array | Uint16Array | Uint32Array;

const kinds = {
  u8: { bytes: 1, Values: Uint8Array },
  u16: { bytes: 2, Values: Uint16Array },
  u24: { bytes: 3, Values: Uint32Array },
};

function decodePlane(bytes: Uint8Array, start: number, count: number, type: Plane['type']): Values {
  const { bytes: size, Values } = kinds[type];
  const values = new Values(count);
  const mask = 2 ** (8 * size) - 1;
  let value = 0;
  for (let i = 0; i < count; ++i) {
    let code = 0;
    for (let k = size - 1; k >= 0; --k) code = (code << 8) | bytes[start + k * count + i];
    value = (value + ((code >>> 1) ^ -(code & 1))) & mask;
    values[i] = value;
  }
  return values;
}

/** The planes of maps one after the other, by map and field. */
export function decodePlanes(
  bytes: Uint8Array,
  maps: { points: number; planes: Plane[] }[],
): Map<string, Values>[] {
  let wanted = 0;
  for (const { points, planes } of maps) {
    for (const plane of planes) wanted += points * kinds[plane.type].bytes;
  }
  if (bytes.length !== wanted) throw new Error(`${bytes.length} bytes of points where ${wanted} were expected`);
  let at = 0;
  return maps.map(({ points, planes }) => {
    const values = new Map<string, Values>();
    for (const { field, type } of planes) {
      values.set(field, decodePlane(bytes, at, points, type));
      at += points * kinds[type].bytes;
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
