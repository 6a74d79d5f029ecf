#!/usr/bin/env python3
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks that links in the repository's Markdown lead somewhere: files, headings of documents, pictures.

usage: check_links.py [--external]
--external: asks for each address outside, too; those that cannot be asked, such as without a network, are named, and are no error.
Ends with 1 for dead links.
"""

import re
import subprocess
import sys
import urllib.error
import urllib.request
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LINK = re.compile(r"!?\[(?:[^\]\[]|\[[^\]]*\])*\]\(([^)\s]+)(?:\s+\"[^\"]*\")?\)")
ADDRESS = re.compile(r"https?://[^\s)>\]\"'`]+")
# Of this machine while the program serves, or made up.
NOWHERE = re.compile(r"https?://(127\.0\.0\.1|localhost|example\.)")


def documents():
    listed = subprocess.run(["git", "ls-files", "-co", "--exclude-standard", "*.md"], cwd=ROOT, capture_output=True, text=True)
    names = listed.stdout.split() if listed.returncode == 0 else [str(f.relative_to(ROOT)) for f in ROOT.glob("docs/**/*.md")]
    return [ROOT / name for name in names]


def prose(text):
    """Without code, where brackets mean something else."""
    text = re.sub(r"^```.*?^```", "", text, flags=re.S | re.M)
    text = re.sub(r"^    .*$", "", text, flags=re.M)
    return re.sub(r"`[^`\n]*`", "`", text)


def anchors(document):
    """Names of headings as GitHub makes them."""
    text = re.sub(r"^```.*?^```", "", document.read_text(), flags=re.S | re.M)
    names = set()
    for heading in re.findall(r"^#+ +(.*?)\s*$", text, re.M):
        heading = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading)
        name = re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
        number = 0
        while (name if number == 0 else f"{name}-{number}") in names:
            number += 1
        names.add(name if number == 0 else f"{name}-{number}")
    return names


def dead_links(document):
    for target in LINK.findall(prose(document.read_text())):
        if re.match(r"[a-z]+:", target):
            continue
        path, _, anchor = target.partition("#")
        file = (document.parent / path).resolve() if path else document
        if not file.exists():
            yield f"{target}: no such file"
        elif ROOT not in [file, *file.parents]:
            yield f"{target}: outside of the repository"
        elif anchor and file.suffix == ".md" and anchor not in anchors(file):
            yield f"{target}: no such heading"


def answer(address):
    """What an address answers: nothing where all is well or where somebody only will not have machines ask; "404"...; or why it
    could not be asked."""
    request = urllib.request.Request(address, method="HEAD", headers={"User-Agent": "Mozilla/5.0 (link check)"})
    try:
        urllib.request.urlopen(request, timeout=15).close()
    except urllib.error.HTTPError as error:
        return str(error.code) if error.code in (404, 410) else None
    except (OSError, ValueError) as error:
        return f"not asked ({error})"
    return None


def main():
    faults = 0
    addresses = {}
    for document in documents():
        for fault in dead_links(document):
            print(f"{document.relative_to(ROOT)}: {fault}")
            faults += 1
        for address in ADDRESS.findall(document.read_text()):
            address = address.rstrip(".,;:")
            if not NOWHERE.match(address):
                addresses.setdefault(address, document.relative_to(ROOT))
    if "--external" in sys.argv:
        for address, document in sorted(addresses.items()):
            said = answer(address)
            if said:
                print(f"{document}: {address}: {said}")
                faults += said.isdigit()
    if faults:
        sys.exit(f"{faults} links lead nowhere.")


if __name__ == "__main__":
    main()
