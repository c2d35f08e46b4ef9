#!/usr/bin/env python3
"""Stands in for tessera_bench: answers its options, runs in no time, and misbehaves as the environment asks.

FAKE_SLOWER: percent that every case is slower. FAKE_NOISE: the spread of its times, percent. FAKE_FAULT: json, empty,
wrong_json, failed_case, missing_case, no_facts, no_items.
"""

import json
import os
import random
import re
import sys

CASES = ["evaluate.positions.blocks/teapot/3/9x9/avx2/1", "evaluate.positions+normals.blocks/teapot/3/9x9/avx2/1",
         "read.obj/bspline/3/20MB/-/1"]
fault = os.environ.get("FAKE_FAULT", "")
options = dict(word.lstrip("-").partition("=")[::2] for word in sys.argv[1:])

if "facts" in options:
    if fault == "no_facts":
        sys.exit(2)
    print(json.dumps({"compiler": "gcc 12.2.0", "build_type": "Release", "flags": "-O3", "isas": ["avx2"], "isa": "avx2",
                      "planted_slowdown": int(os.environ.get("FAKE_PLANTED", "0")), "libraries": {"glibc": "2.36"}}))
    sys.exit(0)
if "roofline" in options:
    isa = {"isa": "avx2", "float_operations": 4e10, "double_operations": 2e10, "plain_store": 7e9, "streaming_store": 9e9}
    points = [{"name": "positions", "per_byte": 1.3, "operations": 9e9, "points": 1e9, "in_cache": c} for c in (True, False)]
    with open(options["roofline"], "w") as file:
        json.dump({"machine": "a machine", "cache_store": 5e10, "isas": [isa], "points": points}, file)
    sys.exit(0)
found = [case + "/manual_time" for case in CASES if re.search(options.get("benchmark_filter", ""), case + "/manual_time")]
if "benchmark_list_tests" in options:
    print("\n".join(found))
    sys.exit(0)

source = random.Random(os.getpid())
slower, noise = float(os.environ.get("FAKE_SLOWER", 0)) / 100, float(os.environ.get("FAKE_NOISE", 0)) / 100
entries = []
for name in found[1:] if fault == "missing_case" else found:
    rate = 1e9 / (1 + slower) / (1 + abs(source.gauss(0, noise)))
    entry = {"name": name.split("/manual_time")[0], "items_per_second": 0 if fault == "no_items" else rate,
             "limit_fraction": 0.5}
    if fault == "failed_case":
        entry.update(error_occurred=True, error_message="the timed values differ from the reference")
    entries.append(entry)
text = {"json": "{\"benchmarks\": [", "wrong_json": "[1, 2]", "empty": ""}.get(fault, json.dumps({"benchmarks": entries}))
with open(options["benchmark_out"], "w") as file:
    file.write(text)
