# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Validates the program's reports against docs/report.schema.json: of teeth, of candidates, of refused crowns.

usage: report_schema.py PROGRAM SOURCE_FOLDER WORK_FOLDER
Needs python3-jsonschema. Ends with 1 if a report does not fit, or if one that was spoiled on purpose does.
"""
import copy
import json
import pathlib
import shutil
import subprocess
import sys

import jsonschema

program, source, work = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
shutil.rmtree(work, ignore_errors=True)
work.mkdir(parents=True)
schema = json.loads((source / "docs/report.schema.json").read_text())
validator_class = jsonschema.validators.validator_for(schema)
validator_class.check_schema(schema)
validator = validator_class(schema)
failures = []


def reports_of(name, crown, expected_code, *options):
    """The reports that one run of `complete` writes, a list."""
    folder = work / name
    folder.mkdir()
    run = subprocess.run([program, "complete", str(crown), "--e", "1", "--quiet", "-o", str(folder / "tooth.ply"),
                          "--report", str(folder / "report.json"), *options], capture_output=True, text=True)
    if run.returncode != expected_code:
        failures.append(f"{name}: exit code {run.returncode} instead of {expected_code}: {run.stderr}")
    found = [json.loads(file.read_text()) for file in sorted(folder.glob("*.json"))]
    if not found:
        failures.append(f"{name}: no report")
    for report in found:
        failures.extend(f"{name}: {'/'.join(map(str, e.absolute_path))}: {e.message}"
                        for e in validator.iter_errors(report))
    return found


samples = source / "samples"
tooth = reports_of("plain", samples / "crown_34.ply", 0, "--fdi", "34")[0]
reports_of("skirt", samples / "skirt_36.ply", 0, "--fdi", "36", "--skirt", "auto", "--repair", "--name-in-report")
candidates = reports_of("candidates", samples / "crown_11.stl", 0, "--candidates", "2")
if len(candidates) != 2:
    failures.append(f"{len(candidates)} reports of 2 candidates")
(work / "bad.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
refused = reports_of("refused", work / "bad.obj", 3, "--fdi", "36")[0]

# The schema asks for something: spoiled reports do not fit.
for what, report in (("tooth", tooth), ("refusal", refused)):
    for key in report:
        spoiled = copy.deepcopy(report)
        spoiled[key] = ["spoiled"] if not isinstance(spoiled[key], list) else "spoiled"
        if validator.is_valid(spoiled):
            failures.append(f"the schema lets pass a {what} whose {key} is {spoiled[key]!r}")
for key in schema["else"]["required"]:
    spoiled = copy.deepcopy(tooth)
    spoiled.pop(key, None)
    if validator.is_valid(spoiled):
        failures.append(f"the schema lets pass a tooth without {key}")

# An arch of two crowns, one of them under a milk tooth's number.
arch_schema = json.loads((source / "docs/arch_report.schema.json").read_text())
arch_validator = jsonschema.validators.validator_for(arch_schema)(arch_schema)
arch_validator.check_schema(arch_schema)
crowns = work / "crowns"
crowns.mkdir()
shutil.copy(samples / "crown_34.ply", crowns / "crown_34.ply")
shutil.copy(samples / "crown_36.stl", crowns / "crown_75.stl")
run = subprocess.run([program, "arch", str(crowns), "--e", "1", "--quiet", "-o", str(work / "arch")],
                     capture_output=True, text=True)
if run.returncode != 6:
    failures.append(f"arch: exit code {run.returncode} instead of 6: {run.stderr}")
else:
    arch = json.loads((work / "arch/arch.json").read_text())
    failures.extend(f"arch: {'/'.join(map(str, e.absolute_path))}: {e.message}" for e in arch_validator.iter_errors(arch))
    failures.extend(f"tooth of an arch: {e.message}"
                    for e in validator.iter_errors(json.loads((work / "arch/tooth_34.json").read_text())))
    for key in arch_schema["required"]:
        spoiled = copy.deepcopy(arch)
        del spoiled[key]
        if arch_validator.is_valid(spoiled):
            failures.append(f"the schema lets pass an arch without {key}")

# An arch whose teeth were searched for says how sure their numbers are.
run = subprocess.run([program, "arch", str(samples / "scan_lower.ply"), "--e", "1", "--quiet", "-o", str(work / "found")],
                     capture_output=True, text=True)
if run.returncode != 0:
    failures.append(f"arch without labels: exit code {run.returncode}: {run.stderr}")
else:
    found = json.loads((work / "found/arch.json").read_text())
    failures.extend(f"arch without labels: {e.message}" for e in arch_validator.iter_errors(found))
    if [tooth["fdi"] for tooth in found["found"]] != [tooth["fdi"] for tooth in found["teeth"]]:
        failures.append("arch without labels: not every tooth has its confidence")
    if arch["found"]:
        failures.append("an arch with labels has confidences of a search")

print("\n".join(failures) if failures else "all reports fit the schema")
sys.exit(1 if failures else 0)
