#!/usr/bin/env python3
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the inputs that the fuzz targets start from, tests/fuzz/corpus/TARGET/*, and their dictionaries."""

import base64
import gzip
import json
import pathlib
import struct
import zlib

HERE = pathlib.Path(__file__).resolve().parent
# an open pyramid on five corners, and the quadrangle under it as a polygon
POINTS = [(0, 0, 0), (8, 0, 0), (8, 8, 0), (0, 8, 0), (4, 4, 6.5)]
TRIANGLES = [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]
LABELS = [36, 36, 0, 0, 36]


def text_of(rows):
    return ''.join(' '.join(str(x) for x in row) + '\n' for row in rows)


def ply(order):
    head = ('ply\nformat ' + {'': 'ascii', '<': 'binary_little_endian', '>': 'binary_big_endian'}[order] +
            ' 1.0\ncomment made by hand\nelement vertex 5\nproperty float x\nproperty float y\nproperty double z\n'
            'property uchar red\nproperty uchar green\nproperty uchar blue\nproperty int label\n'
            'element face 5\nproperty list uchar int vertex_indices\nproperty short part\n'
            'element tristrips 1\nproperty list int int vertex_indices\nend_header\n').encode()
    faces, strip = [*TRIANGLES, (0, 3, 2, 1)], (0, 1, 2, -1, 1, 2, 3)
    if not order:
        return head + (text_of([*p, 200, 100, 5, label] for p, label in zip(POINTS, LABELS)) +
                       text_of([len(f), *f, 7] for f in faces) + text_of([[len(strip), *strip]])).encode()
    body = b''.join(struct.pack(order + 'ffdBBBi', *p, 200, 100, 5, label) for p, label in zip(POINTS, LABELS))
    body += b''.join(struct.pack(f'{order}B{len(f)}ih', len(f), *f, 7) for f in faces)
    return head + body + struct.pack(f'{order}i{len(strip)}i', len(strip), *strip)


def corners():
    return [[POINTS[v] for v in t] for t in TRIANGLES]


def stl_binary(head=b'COLOR=\x10\x20\x30\xff', attribute=0x8123):
    return head.ljust(80, b'\0') + struct.pack('<I', len(TRIANGLES)) + b''.join(
        struct.pack('<12fH', 0, 0, 1, *sum(t, ()), attribute) for t in corners())


def stl_text():
    facets = ''.join('facet normal 0 0 1\n outer loop\n' + ''.join(f'  vertex {x:e} {y} {z}\n' for x, y, z in t) +
                     ' endloop\nendfacet\n' for t in corners())
    return f'solid crown 36\n{facets}endsolid crown 36\nsolid b\n{facets}endsolid\n'.encode()


def obj():
    return ('# crown\nmtllib a.mtl\no tooth\n' + text_of(['v', *p] for p in POINTS) + 'v 1 2 3 0.5 0.25 1\nvt 0 0.5\nvn 0 0 1\n'
            'usemtl enamel\ns off\nf 1/1/1 2/1/1 5/1/1\nf 2//1 3//1 5//1\nf -3 -2 -1\nf 1 4 3 \\\n 2\nl 1 2\n').encode()


def off():
    faces = text_of([len(t), *t] for t in TRIANGLES)
    return {'plain.off': ('OFF\n# crown\n5 5 0\n' + text_of(POINTS) + faces + '4 0 3 2 1 255 0 0\n').encode(),
            'colours.off': ('COFF\n5 4 0\n' + text_of([*p, 255, 128, 0, 255] for p in POINTS) + faces).encode(),
            'normals.off': ('NOFF 5 4 0\n' + text_of([*p, 0, 0, 1] for p in POINTS) + faces).encode(),
            'four.off': ('4OFF 5 4 8\n' + text_of([*p, 1] for p in POINTS) + faces).encode()}


def lz4(data):
    """A block of literals alone."""
    more = len(data) - 15
    return bytes([0xf0 if more >= 0 else len(data) << 4]) + (b'\xff' * (more // 255) + bytes([more % 255]) if more >= 0 else b'') + data


def vtp(storage, compression=None):
    arrays = {'points': ('Float32', 3, struct.pack('<15f', *sum(POINTS, ())), sum(POINTS, ())),
              'connectivity': ('Int64', 1, struct.pack('<16q', *sum(TRIANGLES, ()), 0, 3, 2, 1), [*sum(TRIANGLES, ()), 0, 3, 2, 1]),
              'offsets': ('Int32', 1, struct.pack('<5i', 3, 6, 9, 12, 16), [3, 6, 9, 12, 16]),
              'Label': ('UInt8', 1, bytes(LABELS), LABELS), 'rgb': ('UInt8', 3, bytes(15), [0] * 15)}
    appended = b''

    def array(name):
        nonlocal appended
        kind, components, data, numbers = arrays[name]
        head = f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" format="{storage}"'
        if storage == 'ascii':
            return f'{head}>{" ".join(str(n) for n in numbers)}</DataArray>'
        if compression:
            packed = (zlib.compress if compression == 'ZLib' else lz4)(data)
            sizes, data = struct.pack('<4I', 1, len(data), len(data), len(packed)), packed
        else:
            sizes = struct.pack('<I', len(data))
        if storage == 'binary':
            coded = base64.b64encode(sizes) + base64.b64encode(data) if compression else base64.b64encode(sizes + data)
            return f'{head}>{coded.decode()}</DataArray>'
        head += f' offset="{len(appended)}"/>'
        appended += sizes + data
        return head

    compressor = f' compressor="vtk{compression}DataCompressor"' if compression else ''
    text = (f'<?xml version="1.0"?>\n<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt32"{compressor}>'
            f'<PolyData><Piece NumberOfPoints="5" NumberOfPolys="5"><PointData>{array("Label")}{array("rgb")}</PointData>'
            f'<Points>{array("points")}</Points><Polys>{array("connectivity")}{array("offsets")}</Polys></Piece></PolyData>')
    end = b'<AppendedData encoding="raw">_' + appended + b'</AppendedData>' if storage == 'appended' else b''
    return text.encode() + end + b'</VTKFile>\n'


def vtk(binary, version):
    def numbers(form, values):
        return struct.pack(f'>{len(values)}{form}', *values) + b'\n' if binary else (' '.join(map(str, values)) + '\n').encode()

    data = f'# vtk DataFile Version {version}.0\ncrown\n{"BINARY" if binary else "ASCII"}\nDATASET POLYDATA\nPOINTS 5 float\n'.encode()
    data += numbers('f', sum(POINTS, ()))
    if version < 5:
        data += b'POLYGONS 5 21\n' + numbers('i', sum(((len(f), *f) for f in [*TRIANGLES, (0, 3, 2, 1)]), ()))
        data += b'TRIANGLE_STRIPS 1 5\n' + numbers('i', (4, 0, 1, 2, 3)) + b'LINES 1 3\n' + numbers('i', (2, 0, 1))
    else:
        data += b'POLYGONS 5 12\nOFFSETS vtktypeint64\n' + numbers('q', (0, 3, 6, 9, 12)) + b'CONNECTIVITY vtktypeint64\n'
        data += numbers('q', sum(TRIANGLES, ()))
    data += b'POINT_DATA 5\nSCALARS Label int 1\nLOOKUP_TABLE default\n' + numbers('i', LABELS)
    data += b'FIELD FieldData 1\nheights 1 5 double\n' + numbers('d', [p[2] for p in POINTS])
    return data + b'METADATA\nINFORMATION 0\n\nNORMALS n float\n' + numbers('f', [0, 0, 1] * 5)


def jsons():
    options = {'fdi': 36, 'e_mm': 0.5, 'repair': True, 'skirt': 'auto', 'cap': 'drop', 'millimetres_per_unit': 1, 'transition_mm': None,
               'directions': {'occlusal': [0, 0, 1], 'buccal': [0, 1, 0]},
               'steering': {'root_length_mm': 13.5, 'tip_degrees': 4, 'torque_degrees': -3, 'bend_degrees': 0}, 'threads': 1}
    quality = {'triangles': 4, 'q_avg': 0.9, 'q_min': 0.5, 'theta_avg': 50, 'theta_min': 30, 'theta_max': 90, 'percent_below_30': 0}
    check = {'holds': False, 'failures': ['a'],
             'crown': {'holds': True, 'compared_as': 'float', 'vertices': 5, 'kept_vertices': 5, 'dropped_vertices': [],
                       'merged_vertices': 0, 'merged_distance_max_mm': 0, 'triangles': 4, 'kept_triangles': 4, 'repaired_triangles': 0,
                       'kept_share': 1, 'demanded_triangles': 4, 'broken_triangles': [1],
                       'deviation': {'max_mm': 0, 'mean_mm': 0, 'bins': [1, 0, 0, 0]}},
             'solid': {'holds': True, 'valid': True, 'vertices': 5, 'triangles': 6, 'unreferenced_vertices': 0, 'border_edges': 0,
                       'non_manifold_edges': 0, 'misoriented_edges': 0, 'non_manifold_vertices': 0, 'components': 1, 'euler_number': 2,
                       'genus': 0, 'volume_mm3': 3.5, 'self_intersections': []},
             'quality_new_triangles': quality, 'quality_new_triangles_inner': None, 'quality_new_triangles_at_border': quality,
             'quality_all_triangles': quality}
    measures = {'quality': quality,
                'topology': {**{name: 0 for name in (
                    'vertices edges triangles unreferenced_vertices duplicate_vertices duplicate_triangles degenerate_triangles border_edges '
                    'non_manifold_edges misoriented_edges non_manifold_vertices self_intersections components border_loops euler_number').split()},
                    'genus': None, 'defects': []},
                'size': {'closed': True, 'volume_mm3': 2, 'area_mm2': 9, 'lowest_mm': [0, 0, 0], 'highest_mm': [1, 1, 1], 'diagonal_mm': 2,
                         'edge_min_mm': 1, 'edge_mean_mm': 1, 'edge_max_mm': 1}}
    report = {'report_version': 3, 'input': {'sha256': 'ab'},
              'repairs': [{'action': 'vertex merged with another one at the same place', 'vertices': [3, 2], 'merged_into': [0, 2], 'triangles': [1]}],
              'crown': {'dropped_vertices_by_reason': {'skirt': [2, 3], 'cap': []}}}
    job = {'scan': '0123456789abcdef0123456789abcdef', 'kind': 'arch', 'options': {'e_mm': 0.7, 'skirt': 0.6},
           'root_lengths_mm': {'36': 14.2}, 'resolve_collisions': True, 'clearance_mm': 0.2, 'missing': [38], 'teeth': {'37': [1, 2, 3]},
           'corrections': [{'number': 36, 'at': [1, 2, 3]}, {'merge': [36, 37]}, {'split': 37, 'at': [0, 0, 0]}, {'remove': 38}],
           'labels_are': 'universal', 'jaw': 'lower', 'first_label': 'left', 'label_array': 'Label'}
    tooth = {'scan': 'ab', 'kind': 'tooth', 'options': options}
    return {'options': [options, {'skirt': 0.4, 'fdi': None}], 'check_json': [check, {**check, 'failures': []}],
            'measures_json': [measures, {**measures, 'size': {**measures['size'], 'closed': False}}],
            'report': [report, {'input': {'sha256': 'ab'}, 'refused': 'x'}, {**report, 'repairs': []}],
            'job': [job, tooth], 'steering': [{**options['steering'], 'transition_mm': 0.6}, {'tip_degrees': 5}],
            'labels': [{'id_patient': 'x', 'jaw': 'lower', 'labels': LABELS, 'instances': [1, 1, 0, 0, 1]}, {'labels': [0, 0, 0, 0, 21]}]}


def words_in(value):
    if isinstance(value, dict):
        return {*value, *(w for v in value.values() for w in words_in(v))}
    if isinstance(value, list):
        return {w for v in value for w in words_in(v)}
    return {value} if isinstance(value, str) else set()


def main():
    files = {'ply': {'text.ply': ply(''), 'little.ply': ply('<'), 'big.ply': ply('>')},
             'stl': {'binary.stl': stl_binary(), 'materialise.stl': stl_binary(b'COLOR=\1\2\3\4,MATERIAL=\1\2\3\4', 0), 'text.stl': stl_text()},
             'obj': {'a.obj': obj(), 'b.obj': obj().replace(b'\n', b'\r')}, 'off': off(),
             'vtp': {'text.vtp': vtp('ascii'), 'base64.vtp': vtp('binary'), 'raw.vtp': vtp('appended'), 'zlib.vtp': vtp('appended', 'ZLib'),
                     'lz4.vtp': vtp('appended', 'LZ4'), 'zlib_base64.vtp': vtp('binary', 'ZLib')},
             'vtk': {'text_3.vtk': vtk(False, 3), 'binary_3.vtk': vtk(True, 3), 'text_5.vtk': vtk(False, 5), 'binary_5.vtk': vtk(True, 5)},
             'palette': {'a.txt': b'# colours\n#ff0000 36\n00FF00 37\n', 'b.json': b'{"ff0000": 36, "00ff00": 0}', 'c.json': b'[["ff0000", 36]]'},
             'root_lengths': {'a.csv': b'fdi,mm\n36,14.2\n# none\n37;13\n', 'b.csv': b'11,12\r\n21,12.5\r\n'}}
    files['gzip'] = {name + '.gz': gzip.compress(data, mtime=0) for name, data in
                     [('text.stl', stl_text()), ('little.ply', ply('<')), ('twice.obj', gzip.compress(obj(), mtime=0))]}
    files['any'] = {'utf16.obj': b'\xff\xfe' + obj().decode().encode('utf-16-le'), 'utf16.off': off()['plain.off'].decode().encode('utf-16-be'),
                    'bom.ply': b'\xef\xbb\xbf' + ply(''), 'scene.glb': b'glTF\2\0\0\0\x14\0\0\0\0\0\0\0JSON', 'zip': b'PK\3\4' + bytes(60),
                    'html': b'<!DOCTYPE html><html><body>404</body></html>', 'text.stl': stl_text(), 'binary.stl': stl_binary(b'solid')}
    words = {name: words_in(values) | {'merged across a seam', 'speck dropped', 'null', 'true', '1e999', '-1', '4294967296', '\\u0000'} for name, values in jsons().items()}
    for name, values in jsons().items():
        files[name] = {f'{k}.json': json.dumps(value).encode() for k, value in enumerate(values)}
    words['ply'] = set('ply format ascii binary_little_endian binary_big_endian 1.0 comment obj_info element vertex face tristrips property list '
                       'char uchar short ushort int uint float double int8 uint8 int16 uint16 int32 uint32 float32 float64 x y z red green '
                       'blue alpha vertex_indices vertex_index end_header 18446744073709551615 nan inf'.split())
    words['stl'] = set('solid facet normal outer loop vertex endloop endfacet endsolid color nan inf 1e39 -0'.split()) | {'COLOR=', 'MATERIAL='}
    words['obj'] = set('v vt vn f l o g s usemtl mtllib off -1 1//1 1/1/1 \\ # nan 1e400'.split())
    words['off'] = set('OFF COFF NOFF CNOFF STOFF 4OFF nOFF BINARY # nan 1e400 4294967297'.split())
    words['vtk'] = set('# vtk DataFile Version ASCII BINARY DATASET POLYDATA POINTS POLYGONS TRIANGLE_STRIPS LINES VERTICES OFFSETS CONNECTIVITY '
                       'vtktypeint64 POINT_DATA CELL_DATA SCALARS COLOR_SCALARS LOOKUP_TABLE FIELD FieldData NORMALS VECTORS TENSORS '
                       'TEXTURE_COORDINATES METADATA INFORMATION bit string variant float double int unsigned_char vtkIdType default '
                       '18446744073709551615'.split())
    words['vtp'] = set('VTKFile PolyData Piece Points PointData CellData Polys Strips Lines Verts DataArray AppendedData NumberOfPoints '
                       'NumberOfComponents offset format ascii binary appended encoding raw base64 type Name UInt8 Int8 Int32 Int64 UInt64 '
                       'Float32 Float64 String connectivity offsets compressor vtkZLibDataCompressor vtkLZ4DataCompressor vtkLZMADataCompressor '
                       'byte_order BigEndian header_type &#x41; &amp; <![CDATA[ ]]>'.split())
    words['any'] = words['stl'] | words['off'] | {'ply', 'glTF', 'PK', 'BZh', 'ustar', 'solid', '<VTKFile', '# vtk'}
    words['gzip'] = words['stl'] | {'\x1f', '\x08'}
    words['palette'] = {'#', 'ff0000', '00ff00', '{"', '[["', '36', '-1', '4294967296'}
    words['root_lengths'] = {'36,14.2', '11;', '#', 'nan', '1e400', 'fdi,mm'}
    for target, inputs in files.items():
        (HERE / 'corpus' / target).mkdir(parents=True, exist_ok=True)
        for name, data in inputs.items():
            (HERE / 'corpus' / target / name).write_bytes(data)
    (HERE / 'dictionaries').mkdir(exist_ok=True)
    for target, list_of_words in words.items():
        lines = [''.join(c if ' ' <= c <= '~' and c not in '"\\' else f'\\x{ord(c):02x}' for c in word) for word in sorted(list_of_words) if word]
        (HERE / 'dictionaries' / f'{target}.dict').write_text(''.join(f'"{line}"\n' for line in lines))


if __name__ == '__main__':
    main()
