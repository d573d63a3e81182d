"""Sources and targets that must be refused: the right words, the right exit code, and nothing half made."""
import zipfile

from harness import (RAINIER, build, case, damaged_database, folder_bytes, gdal, main, no_leftovers, require, run, small_dem)


def refuse(folder, source, code, words, *options):
    """Building from `source` ends with `code` and leaves the folder as it was."""
    before = sorted(folder.rglob("*"))
    ended = run("dbbuild", "terrain", source, "-o", folder / "refused.dz", *options, expect=code, words=words)
    require("error: " in ended.err and not ended.out, f"no error line, or something on stdout:\n{ended}")
    require(sorted(folder.rglob("*")) == before, f"something was left: {sorted(set(folder.rglob('*')) - set(before))}")


@case
def a_missing_source_is_refused(folder):
    refuse(folder, folder / "missing.tif", 3, ["missing.tif", "no such file"])


@case
def an_empty_source_is_refused(folder):
    (folder / "empty.tif").write_bytes(b"")
    refuse(folder, folder / "empty.tif", 1, ["empty.tif", "empty"])


@case
def truncated_sources_are_refused(folder):
    content = RAINIER.read_bytes()
    for share in (0.999, 0.5, 0.01):
        (folder / "truncated.tif").write_bytes(content[:int(len(content) * share)])
        refuse(folder, folder / "truncated.tif", 1, ["truncated.tif"])


@case
def what_is_no_raster_is_refused(folder):
    (folder / "letter.tif").write_text("Dear reader,\n" * 100)
    refuse(folder, folder / "letter.tif", 1, ["letter.tif", "not"])
    (folder / "table.csv").write_text("a,b\n1,2\n")
    refuse(folder, folder / "table.csv", 1, ["table.csv"])
    (folder / "a_folder").mkdir()
    refuse(folder, folder / "a_folder", 1, ["a_folder", "folder"])


@case
def an_all_void_source_is_refused(folder):
    small = small_dem(folder)
    gdal("gdal_translate", "-q", "-scale", "-9999", "9999", "5", "5", "-a_nodata", "5", small, folder / "void.tif")
    refuse(folder, folder / "void.tif", 1, ["void"])


@case
def a_source_without_crs_wants_one(folder):
    bare = small_dem(folder, "bare.asc", system="")
    refuse(folder, bare, 2, ["bare.tif", "--crs"])
    refuse(folder, bare, 2, ["--crs"], "--crs", "no such system")
    run("dbbuild", "terrain", bare, "-o", folder / "good.dz", "--crs", "EPSG:4326")


@case
def a_rotated_source_is_refused(folder):
    small = small_dem(folder)
    vrt = folder / "rotated.vrt"
    gdal("gdal_translate", "-q", "-of", "VRT", small, vrt)
    text = vrt.read_text()
    begin, end = text.index("<GeoTransform>"), text.index("</GeoTransform>")
    vrt.write_text(text[:begin] + "<GeoTransform>7.0,0.01,0.001,46.3,0.001,-0.01" + text[end:])
    refuse(folder, vrt, 1, ["rotated"])


@case
def coordinates_of_a_rotated_pole_are_refused(folder):
    turned = folder / "turned.tif"
    gdal("gdal_translate", "-q", "-a_srs", "+proj=ob_tran +o_proj=longlat +o_lon_p=0 +o_lat_p=37.5 +lon_0=10 +datum=WGS84", small_dem(folder), turned)
    refuse(folder, turned, 1, ["turned.tif", "rotated pole", "gdalwarp"])


@case
def a_target_system_without_plane_coordinates_is_refused_by_its_option(folder):
    refuse(folder, small_dem(folder), 1, ["--grid", "geographic or a projected"], "--grid", "EPSG:4978")


@case
def a_source_of_several_bands_is_refused(folder):
    small = small_dem(folder)
    gdal("gdal_translate", "-q", "-b", "1", "-b", "1", small, folder / "bands.tif")
    refuse(folder, folder / "bands.tif", 2, ["bands.tif", "2 bands", "--band"])
    refuse(folder, folder / "bands.tif", 2, ["no band 3"], "--band", "3")


@case
def wrong_values_of_options_are_refused(folder):
    small = small_dem(folder)
    for options in (["--quantum", "0"], ["--quantum", "-1"], ["--quantum", "1e"], ["--bounds", "1,2,3"], ["--bounds", "7,46,7,47"],
                    ["--bounds", "100,0,101,1"], ["--spacing", "30"], ["--spacing", "0m"], ["--spacing", "30m"], ["--grid", "moon"],
                    ["--void", "guess"], ["--band", "0"], ["--nodata", "none"], ["--spacing", "1as", "--grid", "EPSG:32632"]):
        refuse(folder, small, 2, [options[0]], *options)


@case
def an_archive_without_a_raster_is_refused(folder):
    with zipfile.ZipFile(folder / "letters.zip", "w") as archive:
        archive.writestr("letter.txt", "Dear reader")
    refuse(folder, folder / "letters.zip", 1, ["letters.zip", "no raster"])


@case
def an_existing_target_is_refused(folder):
    area = build(folder)
    before = folder_bytes(area)
    run("dbbuild", "terrain", small_dem(folder), "-o", area, expect=2, words=["target exists", "--overwrite"])
    require(folder_bytes(area) == before, "the target was touched")
    no_leftovers(folder)


@case
def what_is_no_database_is_never_overwritten(folder):
    small = small_dem(folder)
    photos = folder / "photos"
    photos.mkdir()
    (photos / "holiday.jpg").write_bytes(b"dear to somebody")
    pretender = folder / "pretender.dz"
    pretender.mkdir()
    (pretender / "area.json").write_text('{"name": "of another program"}')
    empty = folder / "empty.dz"
    empty.mkdir()
    plain = folder / "plain.dz"
    plain.write_text("a file")
    link = folder / "dangling.dz"
    link.symlink_to(folder / "nowhere")
    for target in (photos, pretender, empty, plain, link):
        for options in ([], ["--overwrite"]):
            run("dbbuild", "terrain", small, "-o", target, *options, expect=2, words=[target.name])
    require(folder_bytes(photos) == {"holiday.jpg": b"dear to somebody"}, "photos were touched")
    require(folder_bytes(pretender) == {"area.json": b'{"name": "of another program"}'}, "a stranger's file was touched")
    require(plain.read_text() == "a file" and link.is_symlink(), "a file was touched")
    require(not list(empty.iterdir()), "an empty folder was filled")
    no_leftovers(folder)


@case
def a_database_is_overwritten_when_asked(folder):
    area = build(folder, None, "area.dz", "--leaf", "16")
    small = small_dem(folder)
    digest = run("dbbuild", "info", area, "--digest").out
    run("dbbuild", "terrain", small, "-o", area, "--overwrite", "--leaf", "32")
    require(run("dbbuild", "info", area, "--digest").out != digest, "nothing changed")
    run("dbcheck", area, "--against", small)
    fresh = build(folder, small, "fresh.dz", "--leaf", "32")
    require(run("dbbuild", "info", area, "--digest").out == run("dbbuild", "info", fresh, "--digest").out,
            "overwriting does not give what a fresh build gives")
    require(set(folder_bytes(area)) == {"area.json"} | {file["name"] for file in run("dbbuild", "info", area, "--json").json()["files"]},
            "files of the old state are left")
    # A damaged database may be replaced too.
    damaged = damaged_database(folder)
    run("dbbuild", "terrain", small, "-o", damaged, "--overwrite")
    run("dbcheck", damaged)


@case
def a_target_below_a_missing_folder_is_refused(folder):
    run("dbbuild", "terrain", small_dem(folder), "-o", folder / "no" / "such" / "area.dz", expect=3, words=["no such folder"])
    require(not (folder / "no").exists(), "a folder was made")


@case
def a_failed_export_leaves_nothing(folder):
    area = damaged_database(folder)
    before = sorted(path.name for path in folder.iterdir())
    run("dbbuild", "export", area, "-o", folder / "x.tif", expect=1)
    require(sorted(path.name for path in folder.iterdir()) == before, "something was left")


@case
def a_source_that_is_refused_makes_no_verdict(folder):
    area = build(folder)
    (folder / "letter.tif").write_text("Dear reader")
    ended = run("dbcheck", area, "--against", folder / "letter.tif", expect=1, words=["letter.tif"])
    require("valid" not in ended.out, ended)


if __name__ == "__main__":
    main()
