#!/usr/bin/env python3
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pages that are made of what the program, the schemas and the headers say themselves, so that no page repeats it by hand.

usage: generated_pages.py SOURCE OUT DOXYGEN_XML PROGRAM [TRAINER]
"""

import json
import pathlib
import re
import subprocess
import sys
import xml.etree.ElementTree as xml


def help_of(program, *command):
    asked = subprocess.run([program, *command, "--help"], check=True, capture_output=True, text=True)
    return asked.stdout.rstrip()


def subcommands(help_text):
    """Names of the commands that a help text lists."""
    listed = re.search(r"^Subcommands:\n((?:[ \t].*\n?)+)", help_text, re.M)
    return re.findall(r"^  (\S+)", listed[1], re.M) if listed else []


def commands_page(programs):
    parts = []
    for program in programs:
        name = pathlib.Path(program).name
        todo = [()]
        while todo:
            command = todo.pop(0)
            text = help_of(program, *command)
            todo[:0] = [(*command, sub) for sub in subcommands(text)]
            # The exit codes at the end of each have a page of their own.
            text = text.split("\n\nExit codes:")[0]
            parts.append(f"## `{' '.join((name, *command))}`\n\n```text\n{text}\n```\n")
    return "\n".join(parts)


def type_words(schema):
    if "const" in schema:
        return f"`{json.dumps(schema['const'])}`"
    if "enum" in schema:
        return " or ".join(f"`{json.dumps(value)}`" for value in schema["enum"])
    kind = schema.get("type", "object" if "properties" in schema else "any")
    words = " or ".join(kind) if isinstance(kind, list) else kind
    items = schema.get("items")
    if items:
        words += " of " + type_words(items)
    return words


def schema_rows(schema, root, place=""):
    """(place, type, description) of every value that a schema describes."""
    if "$ref" in schema:
        found = root
        for part in schema["$ref"].removeprefix("#/").split("/"):
            found = found[part]
        schema = {**found, **{k: v for k, v in schema.items() if k != "$ref"}}
    if place:
        yield place, type_words(schema), schema.get("description", "")
    for branch in [*schema.get("anyOf", []), *schema.get("oneOf", []), *schema.get("allOf", [])]:
        for row in schema_rows(branch, root, place):
            if row[0] != place:
                yield row
    for name, part in schema.get("properties", {}).items():
        yield from schema_rows(part, root, f"{place}.{name}" if place else name)
    if isinstance(schema.get("items"), dict):
        for row in schema_rows(schema["items"], root, place + "[]"):
            if row[0] != place + "[]" or row[2]:
                yield row


def schema_page(path):
    schema = json.loads(path.read_text())
    lines = ["| value | type | |", "|---|---|---|"]
    seen = set()
    for place, words, description in schema_rows(schema, schema):
        if place in seen:
            continue
        seen.add(place)
        lines.append(f"| `{place}` | {words} | {description} |".replace("\n", " "))
    return schema.get("description", "") + "\n\n" + "\n".join(lines) + "\n"


def cpp_page(doxygen, source):
    """What each public header declares, in the headers' own words."""
    parts = []
    for header in sorted((source / "include/rhizodont").glob("*.hpp")):
        compound = xml.parse(doxygen / f"{header.stem.replace('_', '__')}_8hpp.xml").getroot().find("compounddef")
        entries = []
        for inner in compound.findall("innerclass"):
            # What stands inside of another class comes with that one; what is only named here has no place of its own.
            if inner.get("prot") == "public" and inner.text.count("::") == 1 and is_defined(doxygen, inner.get("refid")):
                entries.append(("struct" if inner.get("refid").startswith("struct") else "class", inner.text))
        names = set()
        for member in namespace_members(doxygen):
            location = member.find("location")
            if location is None or pathlib.Path(location.get("file")).name != header.name:
                continue
            kind = member.get("kind")
            name = "rhizodont::" + member.findtext("name")
            if kind == "function":
                name += re.sub(r"\s*=[^,)]*", "", member.findtext("argsstring")).removesuffix(" const")
            if name not in names:
                entries.append((kind, name))
                names.add(name)
        if not entries:
            continue
        lines = [f"## `rhizodont/{header.name}`", ""]
        for kind, name in entries:
            members = "\n:members:\n:undoc-members:" if kind in ("struct", "class") else ""
            lines += [f"```{{doxygen{kind}}} {name}{members}", "```", ""]
        parts.append("\n".join(lines))
    return "\n".join(parts)


def is_defined(doxygen, refid):
    body = xml.parse(doxygen / f"{refid}.xml").getroot().find("compounddef/location")
    return body is not None and body.get("bodystart") is not None


def namespace_members(doxygen):
    root = xml.parse(doxygen / "namespacerhizodont.xml").getroot()
    for kind in ("enum", "function", "typedef", "variable"):
        for member in root.iter("memberdef"):
            if member.get("kind") == kind:
                yield member


def main():
    if len(sys.argv) < 5:
        sys.exit(__doc__)
    source, out, doxygen = map(pathlib.Path, sys.argv[1:4])
    out.mkdir(parents=True, exist_ok=True)
    (out / "commands.md").write_text(commands_page(sys.argv[4:]))
    (out / "report.md").write_text(schema_page(source / "docs/report.schema.json"))
    (out / "arch_report.md").write_text(schema_page(source / "docs/arch_report.schema.json"))
    (out / "cpp.md").write_text(cpp_page(doxygen, source))


if __name__ == "__main__":
    main()
