#!/usr/bin/env python3
"""Registration without a start of maps that share a part: how often right, honest and wrong, and the CPU time, beside KISS-Matcher.

    benchmarks/registration/run.py build/release/tools/cmap_align --autzen autzen_stadium_300m.ply --peer peer/bin/python

Right: every corner of the source's box within 0.5 m of where it belongs (the peer, which is coarse: 3 m). Honest: exit code 4. Wrong: exit
code 0 and not right. CPU of cmap_align is that of the whole process, reading included; the peer's that of its call alone.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from scenes import SHARES, make_pairs

RIGHT_M, PEER_RIGHT_M = 0.5, 3.0


def off_m(T, pair):
    """The farthest that a corner of the source's box is misplaced."""
    low, high = pair.source.min(axis=0), pair.source.max(axis=0)
    corners = np.array([[(low, high)[i >> k & 1][k] for k in range(3)] for i in range(8)], float)
    D = T - pair.T_dst_src
    return float(np.linalg.norm(corners @ D[:3, :3].T + D[:3, 3], axis=1).max())


def run_cmap(program, folder, options):
    before = os.times()
    done = subprocess.run([program, folder / "source.npy", folder / "target.npy", "--method", "global", "--json", folder / "a.json",
                           *options], capture_output=True, text=True)
    after = os.times()
    cpu_s = after.children_user + after.children_system - before.children_user - before.children_system
    if not (folder / "a.json").exists():
        return {"exit": done.returncode, "cpu_s": cpu_s, "T": None, "says": done.stderr.strip()[-300:]}
    result = json.loads((folder / "a.json").read_text())
    (folder / "a.json").unlink()
    trusted = done.returncode == 0 and result["verdict"] in ("determined", "weak")  # with --option=--allow-unconverged by its verdict
    return {"exit": 0 if trusted else 4, "cpu_s": cpu_s, "T": np.array(result["T_dst_src"]), "judgment": {
        k: result[k] for k in ("verdict", "reason", "score", "weak", "standard_errors")}}


def run_peer(python, folder, voxel_m):
    subprocess.run([python, Path(__file__).with_name("peer.py"), folder, str(voxel_m)], capture_output=True, check=True)
    result = json.loads((folder / "peer.json").read_text())
    result["T"] = np.array(result["T"])
    return result


def try_pair(args, pair, folder):
    np.save(folder / "source.npy", pair.source)
    np.save(folder / "target.npy", pair.target)
    row = {"scene": pair.scene, "share": pair.share}
    if args.program != "-":
        ours = run_cmap(args.program, folder, args.option)
        error = off_m(ours["T"], pair) if ours["T"] is not None else None
        right = pair.share > 0 and ours["exit"] == 0 and error < RIGHT_M
        row |= {"ours": "right" if right else "honest" if ours["exit"] == 4 else "wrong", "off_m": error, "cpu_s": ours["cpu_s"],
                "judgment": ours.get("judgment"), "says": ours.get("says")}
    if args.peer:
        peer = run_peer(args.peer, folder, pair.voxel_m * args.peer_voxel)
        error = off_m(peer["T"], pair)
        row |= {"peer": "right" if error < PEER_RIGHT_M else "wrong", "peer_off_m": error, "peer_cpu_s": peer["cpu_s"],
                "peer_inliers": peer["inliers"]}
    return row


def show(k, row):
    judgment = row.get("judgment") or {}
    print("%3d %-7s %.2f  %-6s off %8.3f  %5.2f s  %s  %s | peer %-6s off %8.2f  %5.2f s  %s" % (
        k, row["scene"], row["share"], row.get("ours", "-"), row.get("off_m") or -1, row.get("cpu_s", 0), judgment.get("verdict", row.get("says")),
        judgment.get("reason", "")[:110], row.get("peer", "-"), row.get("peer_off_m", -1), row.get("peer_cpu_s", 0), row.get("peer_inliers")), flush=True)


def table(rows, shares):
    print("| shared | pairs | right | honest | wrong | CPU s | peer right | peer CPU s |\n|---|---|---|---|---|---|---|---|")
    for share in (*shares, None):
        of = [r for r in rows if share is None or r["share"] == share]
        count = lambda field, value: sum(r.get(field) == value for r in of)
        mean = lambda field: np.mean([r.get(field, np.nan) for r in of])
        print("| %s | %d | %d | %d | %d | %.2f | %d | %.2f |" % (
            "all" if share is None else "%.0f %%" % (100 * share), len(of), count("ours", "right"), count("ours", "honest"),
            count("ours", "wrong"), mean("cpu_s"), count("peer", "right"), mean("peer_cpu_s")))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="cmap_align, or - for the peer alone")
    parser.add_argument("--autzen", help="autzen_stadium_300m.ply; without it two scenes take part")
    parser.add_argument("--peer", help="the Python of an environment with kiss-matcher 1.0.2 and numpy")
    parser.add_argument("--peer-voxel", type=float, default=1.0, help="its voxel in those of the scene")
    parser.add_argument("--per-share", type=int, default=20, help="pairs of each share; fewer for a quick look")
    parser.add_argument("--shares", default=",".join(map(str, SHARES)), help="0: two places")
    parser.add_argument("--seed", type=int, default=1, help="other seeds were used to choose what the program decides by")
    parser.add_argument("--only", type=int, nargs="*", help="only pairs of these numbers")
    parser.add_argument("--option", action="append", default=[], help="further option of the program")
    parser.add_argument("--out", help="JSON of all pairs to write")
    args = parser.parse_args()
    shares = [float(s) for s in args.shares.split(",")]
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for k, pair in enumerate(make_pairs(args.seed, args.per_share, shares, args.autzen)):
            if args.only and k not in args.only:
                continue
            rows.append(try_pair(args, pair, Path(folder)))
            show(k, rows[-1])
            if args.out:
                Path(args.out).write_text(json.dumps(rows, indent=1, default=str))
    table(rows, shares)
    return any(r.get("ours") == "wrong" for r in rows)


if __name__ == "__main__":
    sys.exit(main())
