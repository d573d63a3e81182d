"""Independent judgement of rasters, by way of GDAL's own programs: whether two say the same."""
import array
import json
import math
import sys

from harness import gdal, require

# Python's codes of GDAL's types.
CODES = {"Byte": "B", "Int16": "h", "UInt16": "H", "Int32": "i", "UInt32": "I", "Float32": "f", "Float64": "d"}


def description(file):
    """What GDAL says of a raster that must survive: size, type, sentinel, place, system, registration, unit."""
    info = json.loads(gdal("gdalinfo", "-json", "-checksum", "-mm", file))
    band = info["bands"][0]
    return {"size": info["size"], "geotransform": info["geoTransform"], "type": band["type"], "nodata": band.get("noDataValue"),
            "unit": band.get("unit", ""), "checksum": band["checksum"], "bands": len(info["bands"]), "extremes": (band.get("computedMin"), band.get("computedMax")),
            "registration": info["metadata"].get("", {}).get("AREA_OR_POINT", "Area"),
            "axes": info["coordinateSystem"]["dataAxisToSRSAxisMapping"],
            "system": gdal("gdalsrsinfo", "-o", "proj4", file).strip()}


def raw_posts(file, folder):
    """The posts as little-endian bytes, row by row from the north, by way of GDAL."""
    raw = folder / "posts.bil"
    gdal("gdal_translate", "-q", "-of", "ENVI", file, raw)
    content = raw.read_bytes()
    for side in folder.glob("posts.*"):
        side.unlink()
    return content


def same_raster(source, exported, folder):
    wanted, found = description(source), description(exported)
    for member, value in wanted.items():
        require(found[member] == value, f"{source.name}: {member} was {value} and came back as {found[member]}")
    require(raw_posts(source, folder) == raw_posts(exported, folder), f"{source.name}: posts differ")
    require(epsg_code(source) == epsg_code(exported), f"{source.name}: another EPSG code")


def epsg_code(file):
    """Without the line that says how sure GDAL is: a GeoTIFF names its code, other formats spell the system out."""
    return [line for line in gdal("gdalsrsinfo", "-e", "-o", "epsg", file).splitlines() if line.startswith("EPSG:")]


def values(file, folder):
    """The stored values of the first band, row by row from the north."""
    kind = json.loads(gdal("gdalinfo", "-json", file))["bands"][0]["type"]
    posts = array.array(CODES[kind])
    posts.frombytes(raw_posts(file, folder))
    if sys.byteorder == "big":
        posts.byteswap()
    return posts


def largest_difference(source, exported, folder):
    """Between the stored values of two rasters; voids (nodata, NaN) must stand at the same posts."""
    nodata = json.loads(gdal("gdalinfo", "-json", source))["bands"][0].get("noDataValue")
    largest = 0.0
    pairs = list(zip(values(source, folder), values(exported, folder), strict=True))
    for wanted, found in pairs:
        void = (isinstance(wanted, float) and math.isnan(wanted)) or wanted == nodata
        if void:
            require(found == wanted or math.isnan(found), f"{source.name}: a void came back as {found}")
        else:
            largest = max(largest, abs(wanted - found))
    require(pairs and math.isfinite(largest), f"{source.name}: nothing was compared")
    return largest
