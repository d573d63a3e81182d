"""dbcheck's verdict on areas that are right, and on what it was not shown."""
from harness import case, flip_bit, gdal, main, require, run, small_dem


def text_grid(folder, name, system, west, south, cell, columns, rows):
    """Hills on a grid of any reference system."""
    lines = [f"ncols {columns}", f"nrows {rows}", f"xllcorner {west!r}", f"yllcorner {south!r}", f"cellsize {cell!r}"]
    lines += [" ".join(str((37 * column * row + 11 * column) % 900) for column in range(columns)) for row in range(rows)]
    text, source = folder / f"{name}.asc", folder / f"{name}.tif"
    text.write_text("\n".join(lines) + "\n")
    gdal("gdal_translate", "-q", "-ot", "Int16", "-a_srs", system, text, source)
    return source


@case
def coarse_maps_of_the_world_are_right(folder):
    half = 20037508.342789244
    for posts in (16, 64, 200, 256):
        source, area = text_grid(folder, f"m{posts}", "EPSG:3857", -half, -half, 2 * half / posts, posts, posts), folder / f"m{posts}.dz"
        run("dbbuild", "terrain", source, "-o", area)
        run("dbcheck", area, "--level", "all", "--against", source)
    # A small map at its edge, where its metres are eleven times those on the ground.
    source, area = text_grid(folder, "edge", "EPSG:3857", 0.0, 19000000.0, 5000.0, 150, 150), folder / "edge.dz"
    run("dbbuild", "terrain", source, "-o", area)
    run("dbcheck", area, "--level", "all", "--against", source)
    globe, area = text_grid(folder, "globe", "EPSG:4326", -182.5, -92.5, 5.0, 73, 37), folder / "globe.dz"
    run("dbbuild", "terrain", globe, "-o", area, "--grid", "EPSG:32610", "--spacing", "100000m", "--bounds", "-150,10,-95,70")
    run("dbcheck", area, "--level", "all", "--against", globe)


@case
def sources_of_one_lattice_are_told_apart(folder):
    first = small_dem(folder)
    gdal("gdal_translate", "-q", "-ot", "Float32", "-scale", "0", "1000", "0.25", "1000.25", first, folder / "second.tif")
    second, area = folder / "second.tif", folder / "two.dz"
    run("dbbuild", "terrain", first, second, "-o", area)
    require(len(run("dbbuild", "info", area, "--json").json()["grids"]) == 2, "one grid of two kinds of storage")
    for order in ([first, second], [second, first]):
        run("dbcheck", area, "--level", "all", "--against", *order)
    for shown, name in ((first, "second.tif"), (second, first.name)):
        ended = run("dbcheck", area, "--against", shown, "--json", expect=4).json()
        require(ended["verdict"] == "unknown" and not ended["issues"] and name in " ".join(ended["skipped"]), ended)


@case
def a_source_outside_the_bounds_is_a_note(folder):
    small = small_dem(folder)
    apart = text_grid(folder, "apart", "EPSG:32610", 500000.0, 4000000.0, 90.0, 30, 30)
    run("dbbuild", "terrain", small, "-o", folder / "whole.dz")
    bounds = run("dbbuild", "info", folder / "whole.dz", "--json").json()["bounds"]
    area = folder / "cut.dz"
    run("dbbuild", "terrain", small, apart, "-o", area, "--bounds", ",".join(repr(bounds[side]) for side in ("west", "south", "east", "north")))
    ended = run("dbcheck", area, "--against", small, apart, "--json").json()
    require(ended["complete"] and len(ended["notes"]) == 1 and "apart.tif" in ended["notes"][0], ended)
    # Without bounds there is no reason to leave it out.
    ended = run("dbcheck", folder / "whole.dz", "--against", small, apart, "--json", expect=1).json()
    require({issue["code"] for issue in ended["issues"]} == {"SRC_GEOREFERENCE"}, ended)


@case
def damage_to_colours_is_found_and_named(folder):
    area = folder / "area.dz"
    run("dbbuild", "terrain", small_dem(folder), "-o", area)
    run("dbbuild", "color", area, "--name", "summer", "--synthetic", "natural")
    require(run("dbcheck", area, "--level", "all", "--json").json()["verdict"] == "valid", "a sound colour map")
    colors = next(file for file in area.iterdir() if file.name.startswith("colors"))
    flip_bit(colors, 40)
    ended = run("dbcheck", area, "--json", expect=1).json()
    issue, = ended["issues"]
    require(issue["code"] == "SUM_BLOCK" and issue["count"] == 1, ended)
    require(colors.name in str(issue), ended)
    colors.unlink()
    ended = run("dbcheck", area, "--json", expect=1).json()
    require({issue["code"] for issue in ended["issues"]} == {"IO_MISSING_FILE"}, ended)


@case
def a_resampled_area_wants_all_its_sources(folder):
    whole = small_dem(folder, void=False)
    gdal("gdal_translate", "-q", "-srcwin", "0", "0", "25", "30", whole, folder / "west.tif")
    gdal("gdal_translate", "-q", "-srcwin", "20", "0", "20", "30", whole, folder / "east.tif")
    west, east, area = folder / "west.tif", folder / "east.tif", folder / "area.dz"
    run("dbbuild", "terrain", west, east, "-o", area, "--spacing", "20as")
    for order in ([west, east], [east, west]):
        require(run("dbcheck", area, "--against", *order, "--json").json()["checked"]["posts_compared"] > 1000, "hardly a post was compared")
    ended = run("dbcheck", area, "--against", west, "--json", expect=4).json()
    require("east.tif" in " ".join(ended["skipped"]), ended)


if __name__ == "__main__":
    main()
