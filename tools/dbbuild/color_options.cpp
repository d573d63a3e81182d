#include "tools/dbbuild/color_options.h"

#include "tools/common/parse.h"

namespace deltaz {

void ColorOptionTexts::addTo(CLI::App& app) {
  app.add_option("--name", name, "Name of the colour map")->required()->type_name("NAME");
  app.add_option(
         "--image", image,
         "Georeferenced images: colour, grey or palette, with or without opacity; the first lies on top")
      ->type_name("ORTHO");
  app.add_option("--ramp", ramp, "Colours by height: text lines `metres R G B [A]`, as gdaldem takes them")
      ->type_name("FILE");
  app.add_option("--classes", classes, "A raster of classes, with --legend or a colour table of its own")
      ->type_name("RASTER");
  app.add_option("--legend", legend, "Colours of the classes: text lines `class R G B [label]`")
      ->type_name("FILE");
  app.add_option("--synthetic", synthetic, "Colours by rule, from height, slope and latitude")
      ->type_name("natural|winter");
  app.add_option("--texel", texel,
                 "Size of the finest texels, in metres (30m) or arc-seconds (1as); by default as fine as the "
                 "images are, else one a cell")
      ->type_name("SIZE");
  app.add_option(
         "--crs", crs,
         "What the coordinates of images refer to, e.g. EPSG:4326; needed where one does not say, and "
         "used, with a warning, where it says otherwise")
      ->type_name("CRS");
  app.add_option("--nodata", nodata, "Stored value that means no colour, whatever the images declare")
      ->type_name("V");
  app.add_flag("--allow-ballpark", allow_ballpark,
               "Accept a change of datum that PROJ can only guess; it may be off by hundreds of metres");
  app.add_flag("--remove", remove, "Take the colour map of this name out of the database");
}

Result<ColorBuildOptions> ColorOptionTexts::parse() const {
  ColorBuildOptions options;
  options.name = name;
  options.images = image;
  options.ramp = ramp;
  options.classes = classes;
  options.legend = legend;
  options.synthetic = synthetic;
  options.crs = crs;
  options.allow_ballpark = allow_ballpark;
  if (!texel.empty()) {
    DELTAZ_TRY_ASSIGN(options.texel, parseSpacing(texel, "--texel"));
  }
  if (!nodata.empty()) {
    DELTAZ_TRY_ASSIGN(options.nodata, parseStoredValue(nodata, "--nodata"));
  }
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) options.provenance.emplace_back(option, value);
  };
  add("allow_ballpark", allow_ballpark ? "yes" : "");
  add("crs", crs);
  add("nodata", nodata);
  add("synthetic", synthetic);
  add("texel", texel);
  return options;
}

}  // namespace deltaz
