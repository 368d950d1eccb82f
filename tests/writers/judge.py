"""One file of one writer: what an independent decoder finds in it, what cmap_eval says of it, and whether both agree."""
import functools
import json
import os
import re
import subprocess
from collections import namedtuple

from cloud import make_cloud
from decode import decode
from scores import closest_pair_m, score

TOLERANCE = 2e-5   # relative
ROUNDING = 2e-6    # absolute: offsets in single precision from an origin in double
# found: scores.Scores or None; stored: in words; said: messages of the program; wrong: why this is a failure, empty if it is none.
Verdict = namedtuple("Verdict", "case found stored exit_code said wrong")


def near(got, low, high):
    """Whether a value lies within [low, high] up to rounding; None only equals None."""
    if got is None or low is None:
        return got is None and low is None
    return low - max(ROUNDING, TOLERANCE * low) <= got <= high + max(ROUNDING, TOLERANCE * high)


def evaluate(program, reference, path):
    """(exit code, metrics or None, messages) of cmap_eval."""
    report_path = path + ".json"
    done = subprocess.run([program, reference, path, "--threads", "1", "-o", report_path],
                          capture_output=True, text=True, errors="replace", timeout=60)
    said = [line for line in done.stderr.splitlines() if line]
    if not os.path.exists(report_path):
        return done.returncode, None, said
    with open(report_path) as stream:
        report = json.load(stream)
    os.remove(report_path)
    return done.returncode, report["metrics"], said + [warning["message"] for warning in report.get("warnings", [])]


@functools.lru_cache
def truth(place):
    cloud = make_cloud(place)
    return cloud.xyz, cloud.rgb, closest_pair_m(cloud.xyz)


def independent(case):
    """(Scores, how it is stored); None for what cannot be decoded."""
    if case.get("undecodable"):
        return None, "not what its header says"
    decoded = decode(case)
    rgb = None if case.get("no_color") else decoded.rgb
    words = [decoded.stored_xyz, decoded.stored_rgb or "no color"]
    stored = ", ".join(dict.fromkeys(words))
    return score(*truth(case["place"]), decoded.xyz, rgb), stored


def disagreement(found, metrics):
    values = {name: (metrics.get(name) or {}).get("value") for name in ("chamfer", "rmse", "color_distance")}
    expected = {"chamfer": (found.chamfer_m,) * 2, "rmse": (found.rmse_m,) * 2, "color_distance": (found.color_low, found.color_high)}
    return "; ".join("%s is %s, decoded %s" % (name, values[name], "..".join(map(str, sorted(set(expected[name]), key=str))))
                     for name in values if not near(values[name], *expected[name]))


def judge(program, reference, case):
    try:
        found, stored = independent(case)
    except (ArithmeticError, LookupError, ValueError) as error:
        return Verdict(case, None, "", None, [], "the decoder of the test fails: %r" % error)
    code, metrics, said = evaluate(program, reference, case["path"])
    named = "says" in case and any(re.search(case["says"], line, re.I) for line in said)
    if "says" in case and not named:
        wrong = "nothing says /%s/ (exit %d)" % (case["says"], code)
    elif code == 0 and found is not None:
        wrong = disagreement(found, metrics)
    elif code == 0:
        wrong = "read, though it does not hold what its header says"
    else:
        wrong = "" if named and code in (3, 4) else "refused (exit %d): %s" % (code, " | ".join(said[-2:]))
    return Verdict(case, found, stored, code, said, wrong)
