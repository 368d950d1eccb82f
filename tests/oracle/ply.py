"""A minimal PLY reader and writer: vertices with x y z and, where present, red green blue."""
import numpy as np

TYPES = {"char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2", "uint16": "u2",
         "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4", "float": "f4", "float32": "f4", "double": "f8", "float64": "f8"}
COLOR_SCALE = {"u1": 255.0, "u2": 65535.0, "f4": 1.0, "f8": 1.0}


def read_header(stream):
    """Return (format, vertex count, [(name, type)]); the vertex element must come first."""
    if stream.readline().strip() != b"ply":
        raise ValueError("not a PLY file")
    form, count, fields, element = None, None, [], None
    while True:
        words = stream.readline().decode("ascii").split()
        if not words:
            raise ValueError("PLY header without end_header")
        if words[0] == "end_header":
            return form, count, fields
        if words[0] == "format":
            form = words[1]
        elif words[0] == "element":
            element = words[1]
            if element == "vertex":
                count = int(words[2])
            elif count is None:
                raise ValueError("the first PLY element is not vertex")
        elif words[0] == "property" and element == "vertex":
            fields.append((words[2], TYPES[words[1]]))


def read_vertices(stream, form, count, fields):
    """Return the vertices as a structured array, each value rounded to its declared type."""
    if form == "binary_little_endian":
        record = np.dtype([(name, "<" + kind) for name, kind in fields])
        data = stream.read(count * record.itemsize)
        return np.frombuffer(data, record, count)
    if form != "ascii":
        raise ValueError("PLY format %s is not supported" % form)
    table = np.loadtxt([stream.readline() for _ in range(count)], dtype=np.float64, ndmin=2)
    vertices = np.empty(count, np.dtype(fields))
    for k, (name, _) in enumerate(fields):
        vertices[name] = table[:, k]
    return vertices


def read_ply(path):
    """Return (points n x 3, colors n x 3 in [0,1] or None), both double; points that are not finite are dropped, NaN is no color, and
    nothing but black is none either."""
    with open(path, "rb") as stream:
        form, count, fields = read_header(stream)
        vertices = read_vertices(stream, form, count, fields)
    points = np.stack([vertices[k].astype(np.float64) for k in "xyz"], axis=1)
    finite = np.isfinite(points).all(axis=1)
    kinds = dict(fields)
    if not {"red", "green", "blue"} <= set(kinds):
        return points[finite], None
    channels = [vertices[k].astype(np.float64) / COLOR_SCALE[kinds[k]] for k in ("red", "green", "blue")]
    colors = np.stack(channels, axis=1)[finite]
    return points[finite], colors if np.nansum(colors) > 0 else None


def write_ply(path, points, colors=None, ascii_text=False):
    """Write float xyz and, where given, uchar rgb (n x 3, 0..255)."""
    fields = [(k, "<f4") for k in "xyz"] + ([(k, "u1") for k in ("red", "green", "blue")] if colors is not None else [])
    vertices = np.empty(len(points), np.dtype(fields))
    for k, name in enumerate("xyz"):
        vertices[name] = points[:, k]
    if colors is not None:
        for k, name in enumerate(("red", "green", "blue")):
            vertices[name] = colors[:, k]
    lines = ["ply", "format %s 1.0" % ("ascii" if ascii_text else "binary_little_endian"), "element vertex %d" % len(points)]
    lines += ["property %s %s" % ("uchar" if kind == "u1" else "float", name) for name, kind in fields] + ["end_header", ""]
    with open(path, "wb") as stream:
        stream.write("\n".join(lines).encode("ascii"))
        if ascii_text:
            rows = ("%s\n" % " ".join("%.9g" % v if kind != "u1" else "%d" % v for v, (_, kind) in zip(row, fields)) for row in vertices)
            stream.write("".join(rows).encode("ascii"))
        else:
            stream.write(vertices.tobytes())
