#!/usr/bin/env python3
"""The layers' arrows go one way: tools -> librender -> libdb -> formats."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
LAYERS = ["formats", "libdb", "librender", "tools"]  # each may include itself and those before it
# Third-party headers that must not be seen in a layer, and those no public header may show.
FORBIDDEN = {
    "formats": r"gdal|ogr|cpl_|png\.h|tiffio|CLI/|tbb/|GeographicLib",
    "libdb": r"png\.h|tiffio|CLI/",
    "librender": r"gdal|ogr|cpl_|png\.h|tiffio|CLI/",
}
THIRD_PARTY = r"gdal|ogr|cpl_|png\.h|tiffio|CLI/|tbb/|GeographicLib|nlohmann|fmt/|xxhash|zstd"

faults = []
seen = 0
for rank, layer in enumerate(LAYERS):
    for path in sorted((ROOT / layer).rglob("*")):
        if path.suffix not in (".h", ".cpp"):
            continue
        seen += 1
        for line_number, line in enumerate(path.read_text().splitlines(), 1):
            match = re.match(r'\s*#\s*include\s*[<"]([^>"]+)[>"]', line)
            if not match:
                continue
            target = match.group(1)
            where = f"{path.relative_to(ROOT)}:{line_number}"
            top = target.split("/")[0]
            if top in LAYERS and LAYERS.index(top) > rank:
                faults.append(f"{where}: {layer} includes {target}")
            if layer in FORBIDDEN and re.match(FORBIDDEN[layer], target):
                faults.append(f"{where}: {layer} must not know {target}")
            if layer != "tools" and path.suffix == ".h" and re.match(THIRD_PARTY, target):
                faults.append(f"{where}: public header shows {target}")
            if top == "tests":
                faults.append(f"{where}: includes a test's header")
        if layer != "tools" and "reinterpret_cast" in path.read_text():
            faults.append(f"{path.relative_to(ROOT)}: reinterpret_cast (file bytes go through formats/bytes.h)")

for fault in faults:
    print(fault)
print(f"{seen} files looked at")
sys.exit(1 if faults or seen < 50 else 0)
