#!/usr/bin/env python3
"""Reads a JSON dump and prints a summary: an example of how to use dumps.

    shadowgraph dump model.glb --format json -o frame.json
    python3 read_dump.py frame.json

`schema.json` next to this file describes every field.
"""

import json
import sys

SCHEMA = 3


def node_path(nodes, node):
    """Returns the path of a node: its name after those of its parents."""
    if node is None:
        return ""
    return node_path(nodes, nodes[node]["parent"]) + nodes[node]["name"] + "/"


def byte_count(desc):
    """Returns the size of a buffer, or of a texture whose format has a known size."""
    if "Buffer" in desc:
        return desc["Buffer"]["bytes"]
    texture = desc["Texture"]
    per_texel = {
        "depth32float": 4, "depth16unorm": 2, "r8unorm": 1, "rg8unorm": 2, "rgba8unorm": 4, "rgba8unorm-srgb": 4,
        "bgra8unorm-srgb": 4, "r16float": 2, "rg16float": 4, "rgba16float": 8, "r32float": 4, "rgba32float": 16,
        "rgba32uint": 16, "r32uint": 4,
    }.get(texture["format"])
    if per_texel is None:
        return None
    size = texture["size"]
    texels = 0
    for mip in range(texture["mip_levels"]):
        texels += max(1, size["width"] >> mip) * max(1, size["height"] >> mip)
    return texels * size["depthOrArrayLayers"] * per_texel * texture["samples"]


def main(file):
    try:
        with open(file, encoding="utf-8") as source:
            dump = json.load(source)
    except (OSError, ValueError) as error:
        sys.exit(f"{file}: {error}")
    schema = dump.get("schema") if isinstance(dump, dict) else None
    if schema != SCHEMA:
        sys.exit(f"{file}: unsupported schema {schema}; expected {SCHEMA}")
    plan, summary = dump["plan"], dump["summary"]
    ran = summary["passes"] - summary["culled"]
    print(f"{ran} passes in {summary['steps']} steps, {summary['culled']} culled")

    print("\nsteps")
    for step, passes in enumerate(plan["order"]):
        names = []
        for index in passes["passes"]:
            entry = plan["passes"][index]
            names.append(node_path(plan["nodes"], entry["node"]) + entry["name"])
        print(f"  {step:>3}  {', '.join(names)}")

    print("\nlargest resources")
    nodes = plan["nodes"]
    sized = [
        (byte_count(resource["desc"]) or 0, node_path(nodes, resource["node"]) + resource["name"])
        for resource in plan["resources"]
    ]
    for size, name in sorted(sized, reverse=True)[:5]:
        print(f"  {size / 1048576:7.1f} MiB  {name}")

    culled = [reason for reason in dump["reasons"] if reason["decision"] == "culled"]
    if culled:
        print("\nculled")
        for reason in culled:
            print(f"  {reason['pass']}: {reason['because']}")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: read_dump.py FRAME.json")
    main(sys.argv[1])
