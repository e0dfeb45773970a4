# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Good files of every format, small and made here: what the mutations spoil. Each list holds bytes."""
import base64
import gzip
import json
import struct
import zlib

EDGE = 0.1  # m
CORNERS = [(x * EDGE, y * EDGE, z * EDGE) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
TRIANGLES = [(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4),
             (2, 6, 3), (3, 6, 7), (0, 4, 2), (2, 4, 6), (1, 3, 5), (3, 7, 5)]


def obj():
    lines = ['o cube'] + ['v %g %g %g' % corner for corner in CORNERS]
    quads = lines + ['f 1 3 4 2', 'f 5 6 8 7', 'f 1 2 6 5', 'f 3 7 8 4', 'f 1 5 7 3', 'f 2 4 8 6']
    lines += ['f %d %d %d' % tuple(v + 1 for v in t) for t in TRIANGLES]
    rich = ['mtllib none.mtl'] + lines[:9] + ['vt 0 0', 'vn 0 0 1', 'usemtl red', 's 1']
    rich += ['f %d/1/1 %d/1/1 %d/1/1' % tuple(v - 8 for v in t) for t in TRIANGLES] + ['l 1 2', 'p 1']
    return ['\n'.join(text).encode() + b'\n' for text in (lines, quads, rich)]


def asciiStl():
    lines = ['solid cube']
    for triangle in TRIANGLES:
        lines += ['facet normal 0 0 0', 'outer loop']
        lines += ['vertex %g %g %g' % CORNERS[v] for v in triangle] + ['endloop', 'endfacet']
    return [('\n'.join(lines + ['endsolid cube']) + '\n').encode()]


def binaryStl():
    out = b' ' * 80 + struct.pack('<I', len(TRIANGLES))
    for triangle in TRIANGLES:
        out += struct.pack('<3f', 0, 0, 0) + b''.join(struct.pack('<3f', *CORNERS[v]) for v in triangle) + b'\0\0'
    return [out]


def plyHeader(form):
    return (f'ply\nformat {form} 1.0\ncomment cube\nelement vertex 8\nproperty float x\nproperty float y\n'
            'property float z\nelement face 12\nproperty list uchar int vertex_indices\nend_header\n').encode()


def ply():
    lines = ['%g %g %g' % corner for corner in CORNERS] + ['3 %d %d %d' % triangle for triangle in TRIANGLES]
    return [plyHeader('ascii') + '\n'.join(lines).encode() + b'\n']


def binaryPly():
    out = []
    for form, order in (('binary_little_endian', '<'), ('binary_big_endian', '>')):
        vertices = b''.join(struct.pack(order + '3f', *corner) for corner in CORNERS)
        faces = b''.join(struct.pack(order + 'B3i', 3, *triangle) for triangle in TRIANGLES)
        out.append(plyHeader(form) + vertices + faces)
    return out


def meshBytes():
    return (b''.join(struct.pack('<3f', *corner) for corner in CORNERS) +
            b''.join(struct.pack('<3I', *triangle) for triangle in TRIANGLES))


def gltfTree(buffer):
    """@param buffer  entries of the buffer beside its length"""
    return {
        'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': [0]}],
        'nodes': [{'name': 'organ', 'children': [1]}, {'name': 'cube', 'mesh': 0, 'translation': [0, 0, 0.1]}],
        'meshes': [{'name': 'shape', 'primitives': [{'attributes': {'POSITION': 0}, 'indices': 1, 'mode': 4}]}],
        'accessors': [{'bufferView': 0, 'componentType': 5126, 'type': 'VEC3', 'count': 8},
                      {'bufferView': 1, 'componentType': 5125, 'type': 'SCALAR', 'count': 36}],
        'bufferViews': [{'buffer': 0, 'byteLength': 96}, {'buffer': 0, 'byteOffset': 96, 'byteLength': 144}],
        'buffers': [dict(buffer, byteLength=240)]}


def gltf():
    uri = 'data:application/octet-stream;base64,' + base64.b64encode(meshBytes()).decode()
    return [json.dumps(gltfTree({'uri': uri})).encode()]


def glbOf(text, binary):
    text += b' ' * (-len(text) % 4)
    chunks = struct.pack('<I', len(text)) + b'JSON' + text + struct.pack('<I', len(binary)) + b'BIN\0' + binary
    return b'glTF' + struct.pack('<II', 2, 12 + len(chunks)) + chunks


def glb():
    return [glbOf(json.dumps(gltfTree({})).encode(), meshBytes())]


def msh():
    nodes = ['%d %g %g %g' % ((i + 1,) + corner) for i, corner in enumerate(CORNERS)]
    cells = [(1, 4, 6, 7), (2, 1, 4, 6), (3, 4, 1, 7), (5, 6, 7, 1), (8, 7, 6, 4)]
    old = ['$MeshFormat', '2.2 0 8', '$EndMeshFormat', '$Nodes', '8'] + nodes + ['$EndNodes', '$Elements', '6', '1 15 2 0 1 1']
    old += ['%d 4 2 0 1 %d %d %d %d' % ((i + 2,) + cell) for i, cell in enumerate(cells)] + ['$EndElements']
    new = ['$MeshFormat', '4.1 0 8', '$EndMeshFormat', '$Nodes', '1 8 1 8', '3 1 0 8'] + [str(i + 1) for i in range(8)]
    new += ['%g %g %g' % corner for corner in CORNERS] + ['$EndNodes', '$Elements', '1 5 1 5', '3 1 4 5']
    new += ['%d %d %d %d %d' % ((i + 1,) + cell) for i, cell in enumerate(cells)] + ['$EndElements']
    return [('\n'.join(lines) + '\n').encode() for lines in (old, new)]


VOXELS_PER_SIDE = 8
AXES_MM = (2, 2, 3)


def voxels():
    """Two labels side by side amid nothing, as int16."""
    side = range(VOXELS_PER_SIDE)
    inside = range(2, VOXELS_PER_SIDE - 2)
    return b''.join(struct.pack('<h', (1 if i < 4 else 5) if i in inside and j in inside and k in inside else 0)
                    for k in side for j in side for i in side)


def nifti():
    one, two = bytearray(352), bytearray(544)
    sizes = [3] + [VOXELS_PER_SIDE] * 3 + [1] * 4
    matrix = [AXES_MM[row] if row == column else 0 for row in range(3) for column in range(4)]
    for data, form, parts in ((one, '<i', ((40, '8h', sizes), (70, '2h', (4, 16)), (76, '4f', (1,) + AXES_MM), (108, 'f', (352,)),
                                           (123, 'B', (2,)), (254, 'h', (1,)), (280, '12f', matrix), (344, '4s', (b'n+1\0',)))),
                              (two, '<i', ((4, '8s', (b'n+2\0\r\n\x1a\n',)), (12, '2h', (4, 16)), (16, '8q', sizes),
                                           (104, '4d', (1,) + AXES_MM), (168, 'q', (544,)), (348, 'i', (1,)),
                                           (400, '12d', matrix), (500, 'i', (2,))))):
        struct.pack_into(form, data, 0, 348 if data is one else 540)
        for at, kind, values in parts:
            struct.pack_into('<' + kind, data, at, *values)
    return [bytes(one) + voxels(), bytes(two) + voxels()]


def nrrd():
    head = ('NRRD0005\ntype: short\ndimension: 3\nspace: left-posterior-superior\nsizes: 8 8 8\n'
            'space directions: (2,0,0) (0,2,0) (0,0,3)\nkinds: domain domain domain\nendian: little\n'
            'space origin: (-8,-8,-12)\n')
    named = ('Segment0_ID:=one\nSegment0_Name:=liver\nSegment0_LabelValue:=1\nSegment0_Layer:=0\n'
             'Segment1_Name:=left kidney\nSegment1_LabelValue:=5\nSegment1_Layer:=0\n')
    layers = head.replace('dimension: 3', 'dimension: 4').replace('sizes: ', 'sizes: 2 ').replace(
        'directions: ', 'directions: none ').replace('kinds: ', 'kinds: list ')
    return [head.encode() + b'encoding: raw\n\n' + voxels(),
            (head + named).encode() + b'encoding: gzip\n\n' + gzip.compress(voxels(), mtime=0),
            (layers + named).encode() + b'encoding: raw\n\n' + voxels() * 2]


def metaImage():
    head = ('ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n'
            'TransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = -8 -8 -12\nElementSpacing = 2 2 3\nDimSize = 8 8 8\n'
            'ElementType = MET_SHORT\n')
    packed = zlib.compress(voxels())
    return [head.encode() + b'ElementDataFile = LOCAL\n' + voxels(),
            (head + f'CompressedData = True\nCompressedDataSize = {len(packed)}\nElementDataFile = LOCAL\n').encode() + packed]


def dicomElement(group, number, kind, value):
    value += b'' if len(value) % 2 == 0 else b'\0' if kind == 'UI' else b' '
    length = struct.pack('<HI', 0, len(value)) if kind in ('OW', 'SQ') else struct.pack('<H', len(value))
    return struct.pack('<HH', group, number) + kind.encode() + length + value


def dicomSequence(group, number, items):
    return dicomElement(group, number, 'SQ', b''.join(struct.pack('<HHI', 0xfffe, 0xe000, len(item)) + item for item in items))


def dicom():
    """A slice with its thickness, and a file of two frames."""
    syntax = dicomElement(2, 0x10, 'UI', b'1.2.840.10008.1.2.1')
    head = bytes(128) + b'DICM' + dicomElement(2, 0, 'UL', struct.pack('<I', len(syntax))) + syntax
    series = dicomElement(8, 0x60, 'CS', b'CT') + dicomElement(0x20, 0xe, 'UI', b'1.2.3')
    turn = dicomElement(0x20, 0x37, 'DS', b'1\\0\\0\\0\\1\\0')
    places = [dicomElement(0x20, 0x32, 'DS', b'-8\\-8\\%d' % z) for z in (0, 3)]
    spacing = dicomElement(0x28, 0x30, 'DS', b'2\\2')
    shorts = lambda *pairs: b''.join(dicomElement(0x28, number, 'US', struct.pack('<H', value)) for number, value in pairs)
    size, form = shorts((0x10, 8), (0x11, 8)), shorts((0x100, 16), (0x101, 16), (0x102, 15), (0x103, 1))
    color = shorts((2, 1)) + dicomElement(0x28, 4, 'CS', b'MONOCHROME2')
    middle = voxels()[3 * 128:5 * 128]
    one = (head + dicomElement(8, 0x16, 'UI', b'1.2.840.10008.5.1.4.1.1.2') + dicomElement(8, 0x60, 'CS', b'CT') +
           dicomElement(0x18, 0x50, 'DS', b'3') + dicomElement(0x20, 0xe, 'UI', b'1.2.3') + places[0] + turn + color + size +
           spacing + form + dicomElement(0x7fe0, 0x10, 'OW', middle[:128]))
    groups = [dicomSequence(0x20, 0x9113, [place]) for place in places]
    shared = dicomSequence(0x20, 0x9116, [turn]) + dicomSequence(0x28, 0x9110, [spacing])
    two = (head + dicomElement(8, 0x16, 'UI', b'1.2.840.10008.5.1.4.1.1.2.1') + series + color +
           dicomElement(0x28, 8, 'IS', b'2') + size + form + dicomSequence(0x5200, 0x9229, [shared]) +
           dicomSequence(0x5200, 0x9230, groups) + dicomElement(0x7fe0, 0x10, 'OW', middle))
    return [one, two]


BLOCK = '''name: block
bodies:
  - name: block
    source: box
    box_size_m: [0.04, 0.04, 0.04]
    spacing_m: 0.01
    fixed: [{shape: plane, point_m: [0, 0, 0.015], normal: [0, 0, -1]}]
'''
SCENE = BLOCK + 'styluses: [{name: left}]\n'
RICH_SCENE = BLOCK + '''    color: [0.7, 0.2, 0.2]
    material: {young_modulus_pa: 20000, poisson_ratio: 0.3, density_kg_per_m3: 1060, mass_damping_per_s: 4, stiffness_damping_ratio: 0.2}
    force_n: [0, 0, 0.01]
  - {name: ball, source: ball, ball_radius_m: 0.02, spacing_m: 0.01, position_m: [0, 0, 0.1], rotation_deg: [0, 10, 0]}
  - {name: cloth, source: sheet, structure: surface, box_size_m: [0.1, 0.1, 0.1], spacing_m: 0.02, thickness_m: 0.001}
styluses:
  - name: left
    idle: probe
    button1: suction
    probe: {radius_m: 0.006}
    max_force_n: 3
    workspace_m: 1
  - {name: right, idle: grab, grab: {radius_m: 0.01, release_speed_m_per_s: 0.5}}
cameras: [{name: eye, position_m: [0, -0.2, 0.05], target_m: [0, 0, 0], width_px: 64, height_px: 48}]
obstacles: [{name: floor, shape: plane, position_m: [0, 0, -0.1], friction: 0.3}]
collision: {bodies: true, friction: 0.2}
environment: {gravity_m_per_s2: [0, 0, -9.81]}
solver: {tick_hz: 60, integrator: leapfrog, dt_fraction: 0.8, stability_monitor: true, iterations: 20}
'''
IMPLICIT_SCENE = BLOCK + 'solver: {integrator: pd, substeps: 2, iterations: 5, threads: 2}\n'
STROKES_TEXT = '''strokes:
  - stylus: left
    keys:
      - {t_s: 0, position_m: [0, 0, 0.05], rotation_deg: [0, 0, 0]}
      - {t_s: 0.01, position_m: [0, 0, 0.03], button1: true}
      - {t_s: 0.02, position_m: [0, 0, 0.01], button2: false}
marks: [{name: deep, t_s: 0.01}]
'''
ANCHORED_TEXT = '''strokes:
  - {stylus: left, anchor: {from_m: [0, 0, 1], towards_m: [0, 0, 0]}, keys: [{t_s: 0, position_m: [0, 0, 0.01]}, {t_s: 0.02}]}
'''

RECORDED_TEXT = '''tick_hz: 60
ticks: 3
input_reset: [1, 3]
strokes:
  - stylus: left
    samples: |
      1 0 0 0.05 0 0 0 1 0 0
      3 0 0 0.03 0 0.6 0 0.8 1 0
'''

OBJ, ASCII_STL, BINARY_STL, PLY, BINARY_PLY, GLTF, GLB, MSH = (
    make() for make in (obj, asciiStl, binaryStl, ply, binaryPly, gltf, glb, msh))
NIFTI, NRRD, METAIMAGE, DICOM = (make() for make in (nifti, nrrd, metaImage, dicom))
ITK_SNAP_TABLE = ['# ITK-SnAP Label Description File\n    0     0    0    0        0  0  0    "Clear Label"\n'
                  '    1   255    0    0        1  1  1    "liver"\n    5     0  255    0        1  1  1    "kidney, left"\n']
YAML_TABLES = ['1: liver\n5: kidney\n', 'liver: 1\n"left kidney": 5\n']
LABEL_TABLES, YAML_TABLES = ([text.encode() for text in texts] for texts in (ITK_SNAP_TABLE, YAML_TABLES))
# Options of import whose values are spoilt, as `name value`.
IMPORT_OPTIONS = [text.encode() for text in ('--labels 1', '--labels 5,1', '--window 1,5', '--window 0.5,2 --closing-mm 3',
                                             '--window 1,5 --pieces 0', '--window 1,5 --fill-holes', '--spacing 0.002', '--axes LPS',
                                             '--transform qform', '--volume 0', '--series 0', '--names none.yaml', '--list')]
SCENES = [text.encode() for text in (SCENE, RICH_SCENE, IMPLICIT_SCENE)]
STROKES = [text.encode() for text in (STROKES_TEXT, ANCHORED_TEXT, RECORDED_TEXT)]
# Options whose values are spoilt, as `name value`.
OPTIONS = [text.encode() for text in ('--seconds 0.02', '--set bodies[0].spacing_m=0.01', '--set solver.tick_hz=60',
                                      '--mesh none.obj', '--strokes none.yaml', '--set bodies[0].fixed=[]', '--device 0',
                                      '--out /proc/none', '--reference', '--no-view', '--live', '--threads 2', 'extra')]
