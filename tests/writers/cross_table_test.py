#!/usr/bin/env python3
"""One cloud written by many libraries and programs, read by cmap_eval and by a decoder of our own: both must give the same errors.

usage: cross_table_test.py CMAP_EVAL FOLDER [--table FILE] [FAMILY...]      a family is a write_*.py beside this file
A family whose packages or programs are missing is left out and named: with Debian's Python only numpy's is there,
make_environment.sh makes the environment of all. Exit 0: all agree; 1: some do not; 77: no family could run.
"""
import argparse
import concurrent.futures
import importlib.metadata
import importlib.util
import json
import os
import shutil
import subprocess
import sys
from collections import namedtuple

HERE = os.path.dirname(os.path.abspath(__file__))
SKIPPED = 77
WRITING_TIME_S = 600  # of a family; seconds on a machine at rest
# A family of writers: its heading, what it needs of Python's packages (module: distribution), programs and their Debian package.
Family = namedtuple("Family", "title modules programs package", defaults=((), (), ""))
FAMILIES = {
    "numpy": Family("numpy, and text as MATLAB and R write it", {"numpy": "numpy"}),
    "pandas": Family("pandas", {"pandas": "pandas"}),
    "laspy": Family("laspy", {"laspy": "laspy"}),
    "plyfile": Family("plyfile", {"plyfile": "plyfile"}),
    "open3d": Family("Open3D", {"open3d": "open3d"}),
    "trimesh": Family("trimesh", {"trimesh": "trimesh"}),
    "pypcd4": Family("pypcd4", {"pypcd4": "pypcd4"}),
    "pcu": Family("point-cloud-utils", {"point_cloud_utils": "point-cloud-utils"}),
    "pyvista": Family("pyvista", {"pyvista": "pyvista"}),
    "pymeshlab": Family("pymeshlab", {"pymeshlab": "pymeshlab"}),
    "meshio": Family("meshio", {"meshio": "meshio"}),
    "pyntcloud": Family("pyntcloud", {"pyntcloud": "pyntcloud"}),
    "pycolmap": Family("pycolmap", {"pycolmap": "pycolmap"}),
    "pcl": Family("PCL's programs", {"numpy": "numpy"}, ["pcl_pcd2ply", "pcl_convert_pcd_ascii_binary"], "pcl-tools"),
    "cloudcompare": Family("CloudCompare", {"numpy": "numpy"}, ["CloudCompare", "xvfb-run"], "cloudcompare"),
}


def missing_for(family):
    needs = FAMILIES[family]
    return [m for m in needs.modules if importlib.util.find_spec(m) is None] + [p for p in needs.programs if shutil.which(p) is None]


def title_of(family):
    """The heading of a family with the version of what writes."""
    title, modules, _, package = FAMILIES[family]
    if package:
        asked = subprocess.run(["dpkg-query", "--show", "--showformat=${Version}", package], capture_output=True, text=True)
        return "%s %s (Debian)" % (title, asked.stdout)
    version = importlib.metadata.version(next(iter(modules.values())))
    first, comma, rest = title.partition(",")
    return "%s %s%s%s" % (first, version, comma, rest)


def write_family(family, folder):
    """The cases of a family, written in a process of its own: these libraries do not all live in one."""
    place = os.path.join(folder, family)
    shutil.rmtree(place, ignore_errors=True)
    try:
        subprocess.run([sys.executable, os.path.join(HERE, "write_%s.py" % family), place], check=True, capture_output=True, text=True,
                       timeout=WRITING_TIME_S)
    except subprocess.SubprocessError as error:
        return [], ["%s: %s %s" % (family, error, str(error.stderr or "")[-500:])]
    with open(os.path.join(place, "cases.json")) as stream:
        written = json.load(stream)
    return [{"family": family, **case} for case in written["cases"]], ["%s: %s" % (family, text) for text in written["failures"]]


def print_verdicts(verdicts):
    for verdict in verdicts:
        if verdict.wrong:
            case = verdict.case
            print("%s, %s, %s: %s" % (case["family"], case["name"], case["place"], verdict.wrong))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cmap_eval")
    parser.add_argument("folder")
    parser.add_argument("families", nargs="*")
    parser.add_argument("--table")
    arguments = parser.parse_args()

    names = arguments.families or list(FAMILIES)
    left_out = {name: missing for name in names if (missing := missing_for(name))}
    for name, missing in left_out.items():
        print("left out: %s (no %s)" % (name, ", ".join(missing)))
    names = [name for name in names if name not in left_out]
    if not names:
        return SKIPPED

    from cloud import ORIGINS_M, make_cloud, write_reference
    from judge import judge
    os.makedirs(arguments.folder, exist_ok=True)
    references = {place: os.path.join(arguments.folder, "reference_%s.ply" % place) for place in ORIGINS_M}
    for place, path in references.items():
        write_reference(make_cloud(place), path)
    with concurrent.futures.ProcessPoolExecutor() as pool:
        written = list(pool.map(write_family, names, [arguments.folder] * len(names)))
        cases = [case for family_cases, _ in written for case in family_cases]
        failures = [text for _, family_failures in written for text in family_failures]
        verdicts = list(pool.map(judge, [arguments.cmap_eval] * len(cases), [references[case["place"]] for case in cases], cases,
                                 chunksize=4))
    print_verdicts(verdicts)
    for text in failures:
        print("not written: " + text)
    n_wrong = sum(bool(verdict.wrong) for verdict in verdicts)
    print("%d files of %d families: %d agree or are named, %d do not" % (len(cases), len(names), len(cases) - n_wrong, n_wrong))
    if arguments.table:
        from table import write_table
        write_table(arguments.table, verdicts, {name: title_of(name) for name in names})
    return 1 if n_wrong or failures else 0


if __name__ == "__main__":
    sys.exit(main())
