"""FBX written as text, turned into the binary form, which is all that Blender reads; runs inside Blender."""
import re

from io_scene_fbx import encode_bin

TOKEN = re.compile(r'"(?P<string>[^"]*)"|(?P<name>[A-Za-z_][\w|]*):|(?P<brace>[{}])|\*(?P<count>\d+)'
                   r"|(?P<number>[-+]?\.?\d[\w.+#-]*)|(?P<word>[A-Za-z]\w*)|;[^\n]*|[,\s]+|.", re.ASCII)
WHOLE_ARRAYS = {"PolygonVertexIndex", "Edges", "Materials", "Smoothing", "Indexes", "KeyAttrFlags", "KeyAttrRefCount"}
WHOLE_PROPERTIES = {"int", "Integer", "bool", "Bool", "enum", "Short", "object"}
LONG_PROPERTIES = {"KTime", "ULongLong", "LongLong"}


class Node:
    def __init__(self, name):
        self.name, self.values, self.children, self.is_array = name, [], [], False


def parsed(text):
    """The tree; values as (kind, text)."""
    root = Node("")
    stack, node = [root], root
    for token in TOKEN.finditer(text):
        kind = token.lastgroup
        if kind == "name":
            node = Node(token["name"])
            stack[-1].children.append(node)
        elif token["brace"] == "{":
            stack.append(node)
        elif token["brace"] == "}":
            node = stack.pop()
        elif kind == "count":
            node.is_array = True
        elif kind in ("string", "number", "word"):
            node.values.append((kind, token[kind]))
    return root


def add_array(element, node):
    numbers = [float(text) for _, text in node.children[0].values] if node.children else []
    if node.name in WHOLE_ARRAYS or (node.name.endswith("Index")):
        element.add_int32_array([int(n) for n in numbers])
    elif node.name == "KeyTime":
        element.add_int64_array([int(n) for n in numbers])
    elif node.name in ("KeyValueFloat", "KeyAttrDataFloat"):
        element.add_float32_array(numbers)
    else:
        element.add_float64_array(numbers)


def add_value(element, node, parent, index):
    kind, text = node.values[index]
    if kind == "string":
        owner, found, own = text.partition("::")
        is_name = found and parent.name == "Objects"
        element.add_string(f"{own}\0\1{owner}".encode() if is_name else text.encode())
    elif kind == "word":
        element.add_bool(text in ("T", "Y"))
    elif node.name == "P" and index >= 4:
        of = node.values[1][1]
        if of in WHOLE_PROPERTIES:
            element.add_int32(int(float(text)))
        elif of in LONG_PROPERTIES:
            element.add_int64(int(text))
        else:
            element.add_float64(float(text))
    elif node.name == "C" or (parent.name == "Objects" and index == 0):
        element.add_int64(int(text))
    elif re.fullmatch(r"[-+]?\d+", text):
        whole = int(text)
        (element.add_int32 if abs(whole) < 2**31 else element.add_int64)(whole)
    else:
        element.add_float64(float(text))


def encoded(node, parent):
    element = encode_bin.FBXElem(node.name.encode())
    if node.is_array:
        add_array(element, node)
        return element
    for index in range(len(node.values)):
        add_value(element, node, parent, index)
    element.elems = [encoded(child, node) for child in node.children if child.name != "Content"]
    return element


def to_binary(path, target):
    with open(path, encoding="utf-8", errors="replace") as file:
        root = parsed(file.read())
    encode_bin.write(target, encoded(root, root), 7400)
