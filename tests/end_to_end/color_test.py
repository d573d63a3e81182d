"""Colour maps through the real programs: images of every kind, ramps, classes, rules; added, replaced, removed, checked."""
import zipfile

from harness import SAMPLES, build, case, folder_bytes, gdal, main, require, run

# The small DEM of the harness: 40 x 30 posts of 0.01 degree from 7.005, 46.005.
WEST, SOUTH, EAST, NORTH = 7.0, 46.0, 7.4, 46.3


def picture(folder, name, color, columns=80, rows=60, options=(), system="EPSG:4326"):
    """A GeoTIFF of `color(column, row)` -> bytes, one, three or four a pixel, over the small DEM unless told otherwise."""
    bands = len(color(0, 0))
    text = folder / (name + ".raw")
    text.write_bytes(b"".join(bytes(color(c, r)) for r in range(rows) for c in range(columns)))
    header = text.with_suffix(".hdr")
    header.write_text(f"nrows {rows}\nncols {columns}\nnbands {bands}\nnbits 8\nlayout bip\n")
    target = folder / (name + ".tif")
    if "-a_ullr" not in options:
        options = ["-a_ullr", WEST, NORTH, EAST, SOUTH, *options]
    if system:
        options = ["-a_srs", system, *options]
    gdal("gdal_translate", "-q", *options, "-of", "GTiff", text, target)
    return target


def gradient(column, row):
    return (3 * column % 256, 4 * row % 256, 90)


def add(area, name, *options, **expected):
    ended = run("dbbuild", "color", area, "--name", name, *options, "--json", **expected)
    run("dbcheck", area, "--level", "decode")
    return ended.json() if ended.code == 0 else ended


@case
def images_of_every_layout_and_system_are_taken(folder):
    area = build(folder)
    terrain = {name: content for name, content in folder_bytes(area).items() if name != "area.json"}
    plain = picture(folder, "plain", gradient)
    add(area, "plain", "--image", plain)
    with zipfile.ZipFile(folder / "archive.zip", "w") as archive:
        archive.write(plain, "inside/plain.tif")
    add(area, "zipped", "--image", folder / "archive.zip")
    add(area, "opaque", "--image", picture(folder, "rgba", lambda c, r: (*gradient(c, r), 255 if c < 40 else 0),
                                           options=["-colorinterp", "red,green,blue,alpha"]))
    add(area, "grey", "--image", picture(folder, "grey", lambda c, r: (c + r,)))
    add(area, "nodata", "--image", picture(folder, "nodata", lambda c, r: (0, 0, 0) if c < 20 else gradient(c, r)), "--nodata", 0)
    for system in ("EPSG:32632", "EPSG:3857", "EPSG:3035"):
        warped = folder / (system.replace(":", "") + ".tif")
        gdal("gdalwarp", "-q", "-t_srs", system, "-dstalpha", plain, warped)
        add(area, system.replace(":", ""), "--image", warped)
    palette = folder / "palette.tif"
    gdal("gdal_translate", "-q", "-of", "VRT", picture(folder, "numbers", lambda c, r: ((c // 8 + r // 8) % 3,)), folder / "palette.vrt")
    text = (folder / "palette.vrt").read_text()
    table = "<ColorTable>" + "".join(f'<Entry c1="{r}" c2="{g}" c3="{b}" c4="255"/>' for r, g, b in ((200, 0, 0), (0, 200, 0), (0, 0, 200)))
    text = text.replace("<ColorInterp>Gray</ColorInterp>", "<ColorInterp>Palette</ColorInterp>" + table + "</ColorTable>")
    (folder / "palette.vrt").write_text(text)
    gdal("gdal_translate", "-q", folder / "palette.vrt", palette)
    add(area, "palette", "--image", palette)
    add(area, "classes", "--classes", palette)
    info = run("dbbuild", "info", area, "--json").json()
    names = [color_map["name"] for color_map in info["color_maps"]]
    require(names == ["plain", "zipped", "opaque", "grey", "nodata", "EPSG32632", "EPSG3857", "EPSG3035", "palette", "classes"], names)
    require(info["color_maps"][0]["sources"][0]["name"] == "plain.tif" and info["color_maps"][0]["origin"] == "image", info)
    after = folder_bytes(area)
    require(all(after[name] == content for name, content in terrain.items()), "a terrain file changed")


@case
def ramps_classes_and_rules_make_maps(folder):
    area = build(folder)
    ramp = folder / "ramp.txt"
    ramp.write_text("# heights\n0% 0 90 40\n400,200,180,120,255\n100% white\nnv 0 0 0 0\n")
    add(area, "ramp", "--ramp", ramp)
    add(area, "natural", "--synthetic", "natural")
    add(area, "winter", "--synthetic", "winter")
    classes = picture(folder, "land", lambda c, r: (10 + (c // 20),))
    ended = add(area, "land", "--classes", classes, expect=2, words=["--legend", "10, 11, 12, 13"])
    legend = folder / "legend.txt"
    legend.write_text("10 200 180 90 30 m meadow\n11 0 90 30 forest\n13 30 60 120\n")
    ended = add(area, "land", "--classes", classes, "--legend", legend)
    require(len(ended["warnings"]) == 1 and "classes 12;" in ended["warnings"][0], ended)
    sources = run("dbbuild", "info", area, "--json").json()["color_maps"][-1]["sources"]
    require([source["name"] for source in sources] == ["land.tif", "legend.txt"], sources)
    run("dbcheck", area, "--level", "all")


@case
def maps_are_replaced_removed_and_their_files_freed(folder):
    area = build(folder)
    before = folder_bytes(area)
    add(area, "one", "--synthetic", "natural")
    add(area, "two", "--synthetic", "winter")
    run("dbbuild", "color", area, "--name", "one", "--synthetic", "winter", expect=2, words=["'one' already", "--overwrite"])
    add(area, "one", "--synthetic", "winter", "--overwrite")
    removed = run("dbbuild", "gc", area, "--json").json()["removed"]
    require(removed == ["colors-000002-000.dzc"], removed)
    info = run("dbbuild", "info", area, "--json").json()
    require([color_map["name"] for color_map in info["color_maps"]] == ["one", "two"], info["color_maps"])
    run("dbbuild", "color", area, "--name", "one", "--remove")
    run("dbbuild", "color", area, "--name", "one", "--remove", expect=2, words=["no colour map 'one'", "it has two"])
    run("dbbuild", "color", area, "--name", "two", "--remove", "--synthetic", "winter", expect=2, words=["--remove"])
    run("dbcheck", area)
    run("dbbuild", "color", area, "--name", "two", "--remove", "-q")
    require(len(run("dbbuild", "gc", area).out.splitlines()) == 2, "not two files were freed")
    after = folder_bytes(area)
    require({name for name in after} == {name for name in before}, sorted(after))
    require(all(after[name] == before[name] for name in before if name != "area.json"), "a terrain file changed")
    require(run("dbbuild", "gc", area).out == "", "gc found something twice")


@case
def the_bytes_depend_on_no_thread_and_no_folder(folder):
    image = picture(folder, "image", gradient, 300, 250)
    warped = folder / "warped.tif"
    gdal("gdalwarp", "-q", "-t_srs", "EPSG:32632", image, warped)
    made = []
    for threads in (1, 2):
        place = folder / f"place{threads}"
        place.mkdir()
        area = build(place)
        add(area, "summer", "--image", warped, image, "-j", threads)
        made.append(folder_bytes(area))
    require(made[0] == made[1], "the bytes differ")


@case
def what_is_wrong_is_named(folder):
    area = build(folder)
    before = folder_bytes(area)
    plain = picture(folder, "plain", gradient)

    def refused(code, words, *options):
        run("dbbuild", "color", area, "--name", "x", *options, expect=code, words=words)
        require(folder_bytes(area) == before, f"the database changed: {options}")

    refused(2, ["--image, --ramp, --classes and --synthetic"])
    refused(2, ["two ways"], "--image", plain, "--synthetic", "natural")
    refused(2, ["natural nor winter"], "--synthetic", "autumn")
    refused(2, ["--legend"], "--image", plain, "--legend", plain)
    refused(2, ["--texel"], "--image", plain, "--texel", "30")
    refused(3, ["missing.tif"], "--image", folder / "missing.tif")
    bare = picture(folder, "bare", gradient, system="")
    refused(2, ["bare.tif", "--crs"], "--image", bare)
    add(area, "crs", "--image", bare, "--crs", "EPSG:4326")
    run("dbbuild", "color", area, "--name", "crs", "--remove")
    run("dbbuild", "gc", area)
    before = folder_bytes(area)
    unplaced = folder / "unplaced.tif"
    gdal("gdal_translate", "-q", "-co", "PROFILE=BASELINE", plain, unplaced)
    for extra in folder.glob("unplaced.tif.*"):
        extra.unlink()
    refused(1, ["not georeferenced", "-a_ullr"], "--image", unplaced)
    gcps = folder / "gcps.tif"
    gdal("gdal_translate", "-q", "-a_srs", "EPSG:4326", "-gcp", 0, 0, 7, 46.3, "-gcp", 80, 0, 7.4, 46.3, "-gcp", 0, 60, 7, 46, unplaced, gcps)
    refused(1, ["ground control points", "gdalwarp"], "--image", gcps)
    beside = picture(folder, "beside", gradient, options=["-a_ullr", 20, 10, 21, 9])
    refused(1, ["beside the area"], "--image", beside)
    floats = folder / "floats.tif"
    gdal("gdal_translate", "-q", "-ot", "Float32", plain, floats)
    refused(1, ["Float32", "-ot Byte"], "--image", floats)
    dark = folder / "dark.tif"
    gdal("gdal_translate", "-q", "-ot", "UInt16", plain, dark)
    refused(1, ["65535", "-scale"], "--image", dark)
    wrong = folder / "wrong.txt"
    wrong.write_text("0 10 20 30\n100 10 20 300\n")
    refused(1, ["wrong.txt, line 2", "300"], "--ramp", wrong)
    wrong.write_text("0 10 20 30\nhigh 10 20 30\n")
    refused(1, ["wrong.txt, line 2", "high"], "--ramp", wrong)
    refused(1, ["wrong.txt, line 2", "high"], "--classes", picture(folder, "land", lambda c, r: (1,)), "--legend", wrong)
    run("dbbuild", "color", area, "--name", "none", "--synthetic", "natural", expect=2, words=["none"])
    run("dbbuild", "color", folder, "--name", "x", "--synthetic", "natural", expect=1, words=["not a deltaz database"])
    run("dbbuild", "gc", folder, expect=1, words=["not a deltaz database"])


@case
def real_pairs_make_sound_maps(folder):
    data = folder / "pair"
    data.mkdir()
    for area in ("crater_lake", "santa_barbara", "zion", "mount_hood"):
        for file in (SAMPLES / area).glob("*.tif"):
            (data / file.name).symlink_to(file)
    pairs = [("craterlake-elev-16bit-30m.tif", [], ["--image", data / "craterlake-imagery-30m.tif"]),
             ("sba_elev32_wgs84_512x512.tif", ["--crs", "EPSG:4326"], ["--image", data / "sba_rgb_wgs84_512x512.tif"]),
             ("zion_srtm.tif", [], ["--classes", data / "zion_nlcd.tif"]),
             ("lf_elev_220_mt_hood_utm.tif", [],
              ["--classes", data / "lf_fbfm40_220_mt_hood_utm.tif", "--legend", SAMPLES / "legends" / "fbfm40.txt"])]
    for dem, of_terrain, of_color in pairs:
        area = folder / (dem + ".dz")
        run("dbbuild", "terrain", data / dem, "-o", area, *of_terrain)
        ended = add(area, "map", *of_color)
        # Zion's classes stand in another datum than its elevations: how they were placed is said, and nothing else.
        require(all(" from datum " in warning for warning in ended["warnings"]) and ended["nodes"] > 20, ended)
        require(bool(ended["warnings"]) == (dem == "zion_srtm.tif"), ended)


if __name__ == "__main__":
    main()
