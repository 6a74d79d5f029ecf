// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/** A mesh as the program sends it to look at ("RZV1"). */
export interface ViewMesh {
  centre: [number, number, number];  // mm, in the scan's frame: what positions are counted from
  position: Float32Array;
  index: Uint32Array;
  perVertex: Map<string, Float32Array>;
  perTriangle: Map<string, Float32Array>;
}

interface Header {
  centre_mm: [number, number, number];
  arrays: { name: string; type: 'float32' | 'uint32'; per: 'vertex' | 'triangle'; offset: number; count: number }[];
}

export function readViewMesh(bytes: ArrayBuffer): ViewMesh {
  const view = new DataView(bytes);
  if (bytes.byteLength < 8 || new TextDecoder().decode(bytes.slice(0, 4)) !== 'RZV1') throw new Error('this is no mesh to look at');
  const length = view.getUint32(4, true);
  const header = JSON.parse(new TextDecoder().decode(bytes.slice(8, 8 + length))) as Header;
  const start = 8 + length;
  const mesh: ViewMesh = {
    centre: header.centre_mm, position: new Float32Array(), index: new Uint32Array(), perVertex: new Map(), perTriangle: new Map(),
  };
  for (const array of header.arrays) {
    if (array.name === 'index') {
      mesh.index = new Uint32Array(bytes, start + array.offset, array.count);
      continue;
    }
    const numbers = new Float32Array(bytes, start + array.offset, array.count);
    if (array.name === 'position') mesh.position = numbers;
    else (array.per === 'vertex' ? mesh.perVertex : mesh.perTriangle).set(array.name, numbers);
  }
  return mesh;
}
