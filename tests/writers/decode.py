"""Reads what the writers wrote, by each format's specification, with numpy alone; shares no code with cmap.

decode(case) gives Decoded: xyz N x 3 double, rgb N x 3 double in [0,1] or None, and how both are stored.
"""
import struct
from collections import namedtuple

import numpy as np

Decoded = namedtuple("Decoded", "xyz rgb stored_xyz stored_rgb")
COLOR_NAMES = (("red", "green", "blue"), ("r", "g", "b"), ("diffuse_red", "diffuse_green", "diffuse_blue"), ("rf", "gf", "bf"))
PLY_TYPES = {"char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2", "uint16": "u2",
             "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4", "int64": "i8", "uint64": "u8",
             "float": "f4", "float32": "f4", "double": "f8", "float64": "f8"}
LAS_COLOR_OFFSET = {2: 20, 3: 28, 5: 28, 7: 30, 8: 30, 10: 30}
STORED = {"f4": "float", "f8": "double", "u1": "8 bit", "u2": "16 bit", "i4": "int32", "u4": "uint32", "i8": "int64", "i2": "int16"}


def stored_as(kind):
    return STORED.get(kind.str[1:], kind.str)


def unit_colors(raw, case):
    """Color numbers as RGB in [0,1]."""
    default = {"u1": 255.0, "u2": 65535.0}.get(raw.dtype.str[1:], 1.0)
    return np.clip(raw.astype(np.float64) / case.get("scale", default), 0.0, 1.0)


def from_records(rows, case, text=False):
    """Decoded of a structured array; names in any case."""
    names = {name.lower(): name for name in rows.dtype.names}
    xyz = np.stack([rows[names[axis]].astype(np.float64) for axis in "xyz"], axis=1)
    found = next((names_of for names_of in COLOR_NAMES if set(names_of) <= set(names)), None)
    stored_xyz = "text" if text else stored_as(rows.dtype[names["x"]])
    if found is None:
        return Decoded(xyz, None, stored_xyz, None)
    raw = np.stack([rows[names[name]] for name in found], axis=1)
    return Decoded(xyz, unit_colors(raw, case), stored_xyz, stored_as(raw.dtype))


def ply_header(stream):
    """(format, [(element, count, [(name, type)])]); a list property has type None."""
    form, elements = None, []
    while True:
        words = stream.readline().decode("latin-1").split()
        if words[:1] == ["format"]:
            form = words[1]
        elif words[:1] == ["element"]:
            elements.append((words[1], int(words[2]), []))
        elif words[:1] == ["property"]:
            elements[-1][2].append((words[-1], None if words[1] == "list" else PLY_TYPES[words[1]]))
        elif words[:1] == ["end_header"]:
            return form, elements


def decode_ply(case):
    with open(case["path"], "rb") as stream:
        form, elements = ply_header(stream)
        for name, count, fields in elements:
            if form == "ascii":
                lines = [stream.readline().split() for _ in range(count)]
            else:
                order = "<" if form == "binary_little_endian" else ">"
                record = np.dtype([(field, order + kind) for field, kind in fields])
                block = stream.read(count * record.itemsize)
            if name == "vertex":
                break
    if form != "ascii":
        return from_records(np.frombuffer(block, record, count), case)
    rows = np.empty(count, np.dtype(fields))
    for k, (field, _) in enumerate(fields):
        rows[field] = [float(line[k]) for line in lines]
    return from_records(rows, case, text=True)


def lzf_decompress(data, size):
    """LZF: a control byte below 32 starts a run of literals, others refer back."""
    out, i = bytearray(), 0
    while i < len(data):
        control = data[i]
        i += 1
        if control < 32:
            out += data[i:i + control + 1]
            i += control + 1
            continue
        length = control >> 5
        if length == 7:
            length += data[i]
            i += 1
        back = ((control & 31) << 8) + data[i] + 1
        i += 1
        for _ in range(length + 2):
            out.append(out[-back])
    assert len(out) == size
    return bytes(out)


def pcd_header(stream):
    header = {}
    while "DATA" not in header:
        words = stream.readline().decode("ascii").split()
        if words and words[0] != "#":
            header[words[0]] = words[1:]
    return header


def pcd_rows(header, stream):
    """The points as a structured array; fields of several numbers are not needed here."""
    kinds = [{"F": "f", "U": "u", "I": "i"}[t] + s for t, s in zip(header["TYPE"], header["SIZE"])]
    fields, count = list(zip(header["FIELDS"], kinds)), int(header["POINTS"][0])
    fields = [(name if name != "_" else "_%d" % k, kind, int(n)) for k, ((name, kind), n) in enumerate(zip(fields, header["COUNT"]))]
    record = np.dtype([(name, kind) if n == 1 else (name, kind, n) for name, kind, n in fields])
    if header["DATA"] == ["binary"]:
        return np.frombuffer(stream.read(count * record.itemsize), record, count)
    rows = np.empty(count, record)
    if header["DATA"] == ["ascii"]:
        lines = [stream.readline().split() for _ in range(count)]
        for k, (name, kind, _) in enumerate(fields):
            rows[name] = [float(line[k]) if kind[0] == "f" else int(line[k]) for line in lines]
        return rows
    packed, size = struct.unpack("<II", stream.read(8))
    columns, at = lzf_decompress(stream.read(packed), size), 0
    for name, kind, n in fields:
        values = np.frombuffer(columns, kind, count * n, at)
        rows[name], at = values.reshape(rows[name].shape), at + values.nbytes
    return rows


def decode_pcd(case):
    with open(case["path"], "rb") as stream:
        header = pcd_header(stream)
        rows = pcd_rows(header, stream)
    text = header["DATA"] == ["ascii"]
    packed = next((name for name in ("rgb", "rgba") if name in rows.dtype.names), None)
    plain = from_records(rows, case, text)
    if packed is None:
        return plain
    bits = np.ascontiguousarray(rows[packed]).view(np.uint32)
    channels = np.stack([(bits >> shift) & 255 for shift in (16, 8, 0)], axis=1).astype(np.uint8)
    return plain._replace(rgb=unit_colors(channels, case), stored_rgb="8 bit packed")


def decode_las(case):
    with open(case["path"], "rb") as stream:
        data = stream.read()
    minor, offset_to_points = data[25], struct.unpack_from("<I", data, 96)[0]
    form, length, count = struct.unpack_from("<BHI", data, 104)
    if minor >= 4:
        count = struct.unpack_from("<Q", data, 247)[0]
    scale, offset = np.array(struct.unpack_from("<3d", data, 131)), np.array(struct.unpack_from("<3d", data, 155))
    points = np.frombuffer(data, np.uint8, count * length, offset_to_points).reshape(count, length)
    raw = np.ascontiguousarray(points[:, :12]).view("<i4")
    xyz = raw * scale + offset
    stored_xyz = "steps of %g m" % scale[0]
    if form not in LAS_COLOR_OFFSET:
        return Decoded(xyz, None, stored_xyz, None)
    at = LAS_COLOR_OFFSET[form]
    colors = np.ascontiguousarray(points[:, at:at + 6]).view("<u2")
    return Decoded(xyz, unit_colors(colors, case), stored_xyz, "16 bit")


def from_columns(table, case, stored):
    """Decoded of a table whose columns the case names."""
    names = case["columns"].split()
    rows = {name: table[:, k] for k, name in enumerate(names)}
    xyz = np.stack([rows[axis] for axis in "xyz"], axis=1).astype(np.float64)
    if "r" not in rows:
        return Decoded(xyz, None, stored, None)
    return Decoded(xyz, unit_colors(np.stack([rows[k] for k in "rgb"], axis=1), case), stored, stored)


def decode_text(case):
    with open(case["path"], encoding="utf-8-sig") as stream:
        lines = stream.read().split("\n")[case.get("skip", 0):]
    if case.get("decimal") == ",":
        lines = [line.replace(",", ".") for line in lines]
    table = [[word.strip('"') for word in line.split(case.get("sep"))] for line in lines if line.strip()]
    wanted = [k for k, name in enumerate(case["columns"].split()) if name != "-"]
    numbers = np.zeros((len(table), len(case["columns"].split())))
    for k in wanted:
        numbers[:, k] = [float(row[k]) for row in table]
    return from_columns(numbers, case, "text")


def decode_npy(case):
    array = np.load(case["path"])
    return from_records(array, case) if array.dtype.names else from_columns(array, case, stored_as(array.dtype))


def decode_npz(case):
    arrays = np.load(case["path"])
    array = arrays[case["key"]]
    if array.dtype.names:
        return from_records(array.ravel(), case)
    if "columns" in case:
        return from_columns(array, case, stored_as(array.dtype))
    xyz = array.reshape(-1, 3)
    if "color_key" not in case:
        return Decoded(xyz.astype(np.float64), None, stored_as(xyz.dtype), None)
    colors = arrays[case["color_key"]].reshape(-1, 3)
    return Decoded(xyz.astype(np.float64), unit_colors(colors, case), stored_as(xyz.dtype), stored_as(colors.dtype))


def decode_kitti(case):
    return Decoded(np.fromfile(case["path"], "<f4").reshape(-1, 4)[:, :3].astype(np.float64), None, "float", None)


def decode_colmap(case):
    """points3D.bin: count, then id, x y z, r g b, error, track length and as many pairs of ids."""
    with open(case["path"], "rb") as stream:
        data = stream.read()
    (count,), at, xyz, rgb = struct.unpack_from("<Q", data), 8, [], []
    for _ in range(count):
        _, x, y, z, r, g, b, _, track = struct.unpack_from("<Q3d3BdQ", data, at)
        xyz.append((x, y, z))
        rgb.append((r, g, b))
        at += 51 + 8 * track
    return Decoded(np.array(xyz), np.array(rgb) / 255.0, "double", "8 bit")


DECODERS = {"ply": decode_ply, "pcd": decode_pcd, "las": decode_las, "npy": decode_npy, "npz": decode_npz}


def decode(case):
    """Decoded of a case of family.Files, by the ending of its name; points that are not finite are left out."""
    path = case["path"]
    if path.endswith(".bin"):
        decoded = decode_colmap(case) if "points3D" in path else decode_kitti(case)
    else:
        decoded = DECODERS.get(path.rsplit(".", 1)[-1], decode_text)(case)
    finite = np.isfinite(decoded.xyz).all(axis=1)
    return decoded._replace(xyz=decoded.xyz[finite], rgb=None if decoded.rgb is None else decoded.rgb[finite])
