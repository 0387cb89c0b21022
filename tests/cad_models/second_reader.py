#!/usr/bin/python3
"""What a reader that shares no code with cad_import says of a CAD file, as one JSON object.

    second_reader.py FILE

Keys: reader (name and version); size_mm, of all triangles' corners (STEP, IGES, BREP: of the faces); nodes
(bodies where they stand: glTF nodes, STEP solids); pieces (connected over shared corners); triangles (none for
STEP, IGES, BREP; polygons count as fans); volume_mm3 (STEP, IGES, BREP). Numbers without a unit are
millimetres. Or: reader, error.

STEP, IGES, BREP: OpenCASCADE's DRAW. STL, OBJ, PLY, glTF, 3DS: VTK, or Blender for what that can't take. COLLADA:
pycollada. FBX: Blender. OFF, 3MF, glTF 1.0: read here. Packages: ./dev packages names them.
"""
import base64
import importlib.metadata
import io
import json
import os
import re
import subprocess
import sys
import tempfile
import zipfile
from xml.etree import ElementTree

import numpy

MM_PER_UNIT = {"micron": 0.001, "millimeter": 1.0, "centimeter": 10.0, "inch": 25.4, "foot": 304.8, "meter": 1000.0}
LONGEST_S = 300


class Refused(Exception):
    """The reader can't take the file; says why."""


class Body:
    """Triangles where they stand: points N x 3, corners M x 3."""

    def __init__(self, points, corners):
        self.points = numpy.asarray(points, dtype=float).reshape(-1, 3)
        self.corners = numpy.asarray(corners, dtype=int).reshape(-1, 3)


def fans(polygons):
    """Polygons as the triangles from their first corners."""
    return [(p[0], p[k], p[k + 1]) for p in polygons for k in range(1, len(p) - 1)]


def moved(points, matrix):
    return numpy.asarray(points, dtype=float) @ matrix[:3, :3].T + matrix[:3, 3]


def joined(bodies):
    """One body of several."""
    starts = numpy.cumsum([0] + [len(b.points) for b in bodies])
    return Body(numpy.concatenate([b.points for b in bodies]),
                numpy.concatenate([b.corners + first for b, first in zip(bodies, starts)]))


def piece_count(bodies):
    """Of triangles connected over equal corners that aren't all one point."""
    points = numpy.concatenate([b.points[b.corners].reshape(-1, 3) for b in bodies])
    # A zero has one sign.
    _, of_corner = numpy.unique(points + 0.0, axis=0, return_inverse=True)
    triangles = of_corner.reshape(-1, 3)
    distinct = (triangles[:, 0] != triangles[:, 1]) & (triangles[:, 1] != triangles[:, 2]) & (
        triangles[:, 2] != triangles[:, 0])
    triangles = triangles[distinct]
    root = numpy.arange(of_corner.max() + 1)
    while True:
        least = root[triangles].min(axis=1)
        new = root.copy()
        for k in range(3):
            numpy.minimum.at(new, root[triangles[:, k]], least)
            numpy.minimum.at(new, triangles[:, k], least)
        new = new[new]
        if (new == root).all():
            return int(len(numpy.unique(root[triangles])))
        root = new


def answer(reader, bodies, mm_per_unit=1.0):
    bodies = [b for b in bodies if len(b.corners)]
    if not bodies:
        raise Refused("no triangles")
    used = numpy.concatenate([b.points[b.corners].reshape(-1, 3) for b in bodies])
    if not numpy.isfinite(used).all():
        raise Refused("a corner isn't at a finite point")
    return {
        "reader": reader,
        "size_mm": ((used.max(axis=0) - used.min(axis=0)) * mm_per_unit).tolist(),
        "nodes": len(bodies),
        "pieces": piece_count(bodies),
        "triangles": sum(len(b.corners) for b in bodies),
    }


# --- OpenCASCADE's DRAW -------------------------------------------------------------------------------------------
def read_brep(path, kind):
    read = {"step": "ReadStep D $file", "iges": "ReadIges D $file", "brep": "restore $file S"}[kind]
    document = "" if kind == "brep" else "XGetOneShape S D\n"
    script = f"""pload MODELING XDE DATAEXCHANGE
set file $env(CAD_FILE)
{read}
{document}puts "SHAPES [nbshapes S -t]"
# Without annotations, which have no faces.
foreach kind {{So F}} {{
  set parts [explode S $kind]
  if {{[llength $parts] > 0}} {{
    eval compound $parts S
    break
  }}
}}
puts "BOX [bounding S -noTriangulation -optimal]"
puts "VOLUME [vprops S 1e-6]"
puts "VERSION [dversion]"
"""
    with tempfile.TemporaryDirectory() as folder:
        source = os.path.join(folder, "ask.tcl")
        with open(source, "w", encoding="utf-8") as file:
            file.write(script)
        run = subprocess.run(["occt-draw", "-b", "-f", source], cwd=folder, timeout=LONGEST_S, text=True,
                             errors="replace", env={**os.environ, "CAD_FILE": os.path.abspath(path)},
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    version = re.search(r"Open CASCADE Technology ([\d.]+)", run.stdout)
    reader = "DRAW " + (version.group(1) if version else "")
    number = r"(-?[\d.]+(?:e[-+]?\d+)?)"
    box = re.search(r"BOX " + " ".join([number] * 6), run.stdout)
    if not box:
        raise Refused(reader + ": " + " ".join(run.stdout.split()[-12:]))
    low_high = [float(x) for x in box.groups()]
    counts = {name: int(count) for name, count in re.findall(r"(\w+) +: (\d+)", run.stdout.partition("BOX")[0])}
    volume = re.search(r"Mass : +" + number, run.stdout)
    return {
        "reader": reader.strip(),
        "size_mm": [low_high[k + 3] - low_high[k] for k in range(3)],
        "nodes": counts["SOLID"],
        "shells": counts["SHELL"],
        "volume_mm3": float(volume.group(1)) if volume else None,
    }


# --- VTK ----------------------------------------------------------------------------------------------------------
def of_poly_data(data):
    from vtkmodules.util.numpy_support import vtk_to_numpy

    def cells(array):
        corners, ends = vtk_to_numpy(array.GetConnectivityArray()), vtk_to_numpy(array.GetOffsetsArray())
        return [corners[a:b] for a, b in zip(ends[:-1], ends[1:])] if len(ends) else []

    strips = [strip[k:k + 3] for strip in cells(data.GetStrips()) for k in range(len(strip) - 2)]
    corners = fans(cells(data.GetPolys())) + [tuple(t) for t in strips]
    return Body(vtk_to_numpy(data.GetPoints().GetData()) if corners else [], corners)


def parted(data, label):
    """A body for each value of a cell's label."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkFiltersCore import vtkThreshold
    from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter
    if not label or not data.GetCellData().HasArray(label):
        return [of_poly_data(data)]
    bodies = []
    for value in numpy.unique(vtk_to_numpy(data.GetCellData().GetArray(label))):
        some = vtkThreshold()
        some.SetInputData(data)
        some.SetInputArrayToProcess(0, 0, 0, 1, label)
        some.SetLowerThreshold(float(value))
        some.SetUpperThreshold(float(value))
        surface = vtkGeometryFilter()
        surface.SetInputConnection(some.GetOutputPort())
        surface.MergingOff()
        surface.Update()
        bodies.append(of_poly_data(surface.GetOutput()))
    return bodies


def read_vtk(path, kind):
    from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow, vtkVersion
    said = vtkStringOutputWindow()
    vtkOutputWindow.SetInstance(said)
    bodies = {"gltf": vtk_gltf, "3ds": vtk_3ds}.get(kind, vtk_surface)(path, kind)
    reader = "VTK " + vtkVersion.GetVTKVersion()
    if not any(len(b.corners) for b in bodies) and said.GetOutput():
        raise Refused(reader + ": " + " ".join(said.GetOutput().split("\n")[1].split()))
    said = answer(reader, bodies, 1000.0 if kind == "gltf" else 1.0)
    return {**said, "nodes": obj_groups(path)} if kind == "obj" else said


def vtk_surface(path, kind):
    from vtkmodules.vtkIOGeometry import vtkOBJReader, vtkSTLReader
    from vtkmodules.vtkIOPLY import vtkPLYReader
    reader = {"stl": vtkSTLReader, "obj": vtkOBJReader, "ply": vtkPLYReader}[kind]()
    if kind == "stl":
        reader.MergingOff()
        reader.ScalarTagsOn()
    reader.SetFileName(path)
    reader.Update()
    return parted(reader.GetOutput(), "STLSolidLabeling")


def obj_groups(path):
    """Named objects and groups with faces, which VTK doesn't tell apart."""
    name, groups = "", set()
    with open(path, encoding="utf-8", errors="replace") as file:
        for line in file:
            key, _, rest = line.strip().partition(" ")
            if key in ("o", "g"):
                name = rest.strip()
            elif key == "f":
                groups.add(name)
    return len(groups)


def vtk_gltf(path, _kind):
    from vtkmodules.vtkIOGeometry import vtkGLTFReader
    reader = vtkGLTFReader()
    reader.SetFileName(path)
    reader.Update()
    bodies = []

    def visit(block):
        blocks = [block.GetBlock(k) for k in range(block.GetNumberOfBlocks())]
        primitives = [of_poly_data(b) for b in blocks if hasattr(b, "GetNumberOfPoints") and b.IsA("vtkPolyData")]
        if primitives:
            bodies.append(joined(primitives))
        for inner in blocks:
            if inner is not None and inner.IsA("vtkMultiBlockDataSet"):
                visit(inner)

    visit(reader.GetOutput())
    return bodies


def vtk_3ds(path, _kind):
    from vtkmodules.vtkIOImport import vtk3DSImporter
    importer = vtk3DSImporter()
    importer.SetFileName(path)
    importer.Update()
    actors = importer.GetRenderer().GetActors()
    actors.InitTraversal()
    bodies = []
    while (actor := actors.GetNextActor()) is not None:
        actor.GetMapper().Update()
        bodies.append(of_poly_data(actor.GetMapper().GetInput()))
    return bodies


# --- others -------------------------------------------------------------------------------------------------------
def read_off(path, _kind):
    with open(path, encoding="utf-8", errors="replace") as file:
        lines = [words for line in file if (words := line.partition("#")[0].split())]
    if lines:
        lines[0] = re.sub(r"^[A-Z]*OFF", "", " ".join(lines[0])).split()
    lines = [words for words in lines if words]
    if not lines:
        raise Refused("no text")
    point_count, face_count = int(lines[0][0]), int(lines[0][1])
    if len(lines) < 1 + point_count + face_count:
        raise Refused("its text ends too soon")
    points = [[float(word) for word in words[:3]] for words in lines[1:1 + point_count]]
    faces = lines[1 + point_count:1 + point_count + face_count]
    # A face ends where its line does: colours may follow.
    return answer("its text", [Body(points, fans([[int(w) for w in words[1:1 + int(words[0])]] for words in faces]))])


def read_collada(path, _kind):
    import collada
    with open(path, "rb") as file:
        text = re.sub(rb"(?<=\d),(?=\d{6}\b)", b".", file.read())  # some were written with decimal commas
    tree = ElementTree.fromstring(text)
    # The shape alone: what it looks like is often damaged.
    for element in tree.iter():
        for part in list(element):
            if re.search(r"}(bind_material|(library|instance)_(effects|materials|images|lights?|cameras?))$", part.tag):
                element.remove(part)
    document = collada.Collada(io.BytesIO(ElementTree.tostring(tree)), ignore=[collada.common.DaeError])
    reader = "pycollada " + importlib.metadata.version("pycollada")
    if document.scene is None:
        raise Refused(reader + ": no scene")
    bodies = []
    for geometry in document.scene.objects("geometry"):
        primitives = []
        for primitive in geometry.primitives():
            if isinstance(primitive, collada.lineset.BoundLineSet) or primitive.vertex is None:
                continue
            polygons = primitive.vertex_index
            if isinstance(primitive, collada.polylist.BoundPolylist):
                polygons = [p.indices for p in primitive.polygons()]
            primitives.append(Body(primitive.vertex, fans(polygons)))
        if primitives:
            bodies.append(joined(primitives))
    return answer(reader, bodies, 1000.0 * (document.assetInfo.unitmeter or 1.0))


def read_3mf(path, _kind):
    with zipfile.ZipFile(path) as archive:
        name = next(n for n in archive.namelist() if n.lower().endswith(".model"))
        model = ElementTree.fromstring(archive.read(name))

    def children(element, tag):
        return [] if element is None else [e for e in element if e.tag.rpartition("}")[2] == tag]

    def child(element, tag):
        return next(iter(children(element, tag)), None)

    def placement(element):
        matrix = numpy.eye(4)
        if element.get("transform"):
            matrix[:3, :] = numpy.array([float(x) for x in element.get("transform").split()]).reshape(4, 3).T
        return matrix

    objects = {o.get("id"): o for o in children(child(model, "resources"), "object")}
    bodies = []

    def visit(identity, matrix):
        mesh = child(objects[identity], "mesh")
        if mesh is not None:
            points = [[float(v.get(axis)) for axis in "xyz"] for v in children(child(mesh, "vertices"), "vertex")]
            corners = [[int(t.get(v)) for v in ("v1", "v2", "v3")]
                       for t in children(child(mesh, "triangles"), "triangle")]
            if corners:
                bodies.append(Body(moved(points, matrix), corners))
        for part in children(child(objects[identity], "components"), "component"):
            visit(part.get("objectid"), matrix @ placement(part))

    for item in children(child(model, "build"), "item"):
        visit(item.get("objectid"), placement(item))
    return answer("its XML", bodies, MM_PER_UNIT[model.get("unit", "millimeter")])


def read_gltf1(path, _kind):
    """glTF 1.0, which keeps under names what 2.0 lists."""
    with open(path, encoding="utf-8") as file:
        document = json.load(file)
    if not str(document.get("asset", {}).get("version", "")).startswith("1"):
        raise Refused("not glTF 1.0")

    def bytes_of(name):
        uri = document["buffers"][name]["uri"]
        if uri.startswith("data:"):
            return base64.b64decode(uri.partition(",")[2])
        with open(os.path.join(os.path.dirname(path), uri), "rb") as file:
            return file.read()

    def numbers(name):
        accessor = document["accessors"][name]
        view = document["bufferViews"][accessor["bufferView"]]
        count, width = accessor["count"], {"SCALAR": 1, "VEC3": 3}[accessor["type"]]
        kind = numpy.dtype({5121: "u1", 5123: "<u2", 5125: "<u4", 5126: "<f4"}[accessor["componentType"]])
        return numpy.ndarray((count, width), kind, bytes_of(view["buffer"]),
                             view.get("byteOffset", 0) + accessor.get("byteOffset", 0),
                             (accessor.get("byteStride") or width * kind.itemsize, kind.itemsize))

    def placement(node):
        if "matrix" in node:
            return numpy.array(node["matrix"], dtype=float).reshape(4, 4).T
        x, y, z, w = node.get("rotation", [0, 0, 0, 1])
        matrix = numpy.eye(4)
        matrix[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                          [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                          [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
        matrix[:3, :3] *= numpy.array(node.get("scale", [1, 1, 1]))
        matrix[:3, 3] = node.get("translation", [0, 0, 0])
        return matrix

    bodies = []

    def visit(name, parent):
        node = document["nodes"][name]
        matrix = parent @ placement(node)
        primitives = []
        for mesh in node.get("meshes", []):
            for primitive in document["meshes"][mesh]["primitives"]:
                if primitive.get("mode", 4) == 4:
                    points = numbers(primitive["attributes"]["POSITION"])
                    corners = numbers(primitive["indices"]) if "indices" in primitive else numpy.arange(len(points))
                    primitives.append(Body(moved(points, matrix), corners))
        if primitives:
            bodies.append(joined(primitives))
        for child in node.get("children", []):
            visit(child, matrix)

    for root in document["scenes"][document["scene"]]["nodes"]:
        visit(root, numpy.eye(4))
    return answer("its JSON", bodies, 1000.0)


# --- Blender: this script again, inside it ------------------------------------------------------------------------
def read_blender(path, _kind):
    run = subprocess.run(["blender", "-b", "--factory-startup", "--python", __file__, "--", path], timeout=LONGEST_S,
                         text=True, errors="replace", stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    lines = [line for line in run.stdout.splitlines() if line.startswith("{")]
    if not lines:
        raise Refused("Blender: " + run.stdout[-300:])
    said = json.loads(lines[-1])
    if "error" in said:
        raise Refused(said["error"])
    return said


def binary_fbx(path):
    with open(path, "rb") as file:
        if file.read(18) == b"Kaydara FBX Binary":
            return path
    sys.path.append(os.path.dirname(__file__))
    import text_fbx
    target = os.path.join(tempfile.mkdtemp(), "binary.fbx")
    text_fbx.to_binary(path, target)
    return target


def inside_blender(path):
    import bpy
    numpy.bool = bool  # as Blender's importers knew it
    reader = "Blender " + bpy.app.version_string
    bpy.ops.wm.read_factory_settings(use_empty=True)
    kind = extension(path)
    file_from_scene, mm_per_unit = numpy.eye(4), 1.0
    try:
        # Axes as the file has them.
        if kind == "fbx":
            bpy.ops.import_scene.fbx(filepath=binary_fbx(path), use_manual_orientation=True, axis_forward="Y", axis_up="Z",
                                     use_anim=False)
            mm_per_unit = 1000.0
        elif kind in ("gltf", "glb"):
            bpy.ops.import_scene.gltf(filepath=path)
            file_from_scene[:3, :3] = [[1, 0, 0], [0, 0, 1], [0, -1, 0]]
            mm_per_unit = 1000.0
        elif kind == "obj":
            bpy.ops.import_scene.obj(filepath=path, axis_forward="Y", axis_up="Z", use_split_objects=True,
                                     use_split_groups=True)
        elif kind == "ply":
            bpy.ops.import_mesh.ply(filepath=path)
    except RuntimeError as error:
        raise Refused(reader + ": " + str(error)) from error
    bodies = []
    for thing in bpy.data.objects:
        if thing.type == "MESH" and thing.data.polygons:
            corners = fans([tuple(p.vertices) for p in thing.data.polygons])
            points = [v.co for v in thing.data.vertices]
            bodies.append(Body(moved(points, file_from_scene @ numpy.array(thing.matrix_world)), corners))
    return answer(reader, bodies, mm_per_unit)


# ------------------------------------------------------------------------------------------------------------------
def extension(path):
    return path.lower().rpartition(".")[2]


# The first that can read the file.
READERS = {
    "step": [read_brep], "iges": [read_brep], "brep": [read_brep], "stl": [read_vtk],
    "obj": [read_vtk, read_blender], "ply": [read_vtk, read_blender], "off": [read_off],
    "gltf": [read_vtk, read_blender, read_gltf1], "3mf": [read_3mf], "dae": [read_collada], "fbx": [read_blender],
    "3ds": [read_vtk],
}
KIND = {"stp": "step", "p21": "step", "igs": "iges", "glb": "gltf"}


def in_short(text):
    """The last words of a traceback, or all there is, on one line."""
    said = re.findall(r"^\w*(?:Error|Exception): .*", text, re.MULTILINE) if "Traceback" in text else []
    words = " ".join((said[-1] if said else text).split())
    return re.sub(r"\(0x[0-9a-f]+\)|/\S*/", "", words)[:160]


def said_by(ask, *words):
    try:
        return ask(*words)
    except Refused as refused:
        return {"error": in_short(str(refused))}
    except Exception as error:  # whatever a reader throws is its answer
        return {"error": in_short(f"{type(error).__name__}: {error}")}


def said_by_child(ask, path, kind):
    """In a process of its own: readers crash."""
    out, into = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(out)
        quiet = os.open(os.devnull, os.O_WRONLY)
        os.dup2(quiet, 1)
        os.dup2(quiet, 2)
        with os.fdopen(into, "w") as pipe:
            pipe.write(json.dumps(said_by(ask, path, kind)))
        os._exit(0)
    os.close(into)
    with os.fdopen(out) as pipe:
        text = pipe.read()
    _, status = os.waitpid(child, 0)
    name = ask.__name__.removeprefix("read_")
    return json.loads(text) if text else {"error": f"{name} crashed (status {os.waitstatus_to_exitcode(status)})"}


def main(words):
    if "--" in words:
        return said_by(inside_blender, words[-1])
    path = words[1]
    kind = KIND.get(extension(path), extension(path))
    refusals = []
    for ask in READERS[kind]:
        said = said_by_child(ask, path, kind)
        if "error" not in said:
            return said
        refusals.append(said["error"])
    return {"error": "; ".join(refusals)}


print("\n" + json.dumps(main(sys.argv)), flush=True)
