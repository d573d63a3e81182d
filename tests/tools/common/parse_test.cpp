#include "tools/common/parse.h"

#include <clocale>
#include <cmath>
#include <gtest/gtest.h>

namespace deltaz {
namespace {

TEST(Parse, numbers_are_taken_whole) {
  EXPECT_EQ(parseNumber("-12.5", "--x").value(), -12.5);
  EXPECT_EQ(parseNumber("+7", "--x").value(), 7);
  EXPECT_EQ(parseNumber("1e3", "--x").value(), 1000);
  for (const char* text :
       {"", " 1", "1 ", "1,5", "1x", "nan", "inf", "-inf", "0x10", "+", "-", "+-1", "1e999", "--1"}) {
    EXPECT_FALSE(parseNumber(text, "--x").ok()) << text;
  }
}

TEST(Parse, errors_are_usage_and_name_the_option) {
  const auto result = parseNumber("abc", "--fov");
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().kind, ErrorKind::kUsage);
  EXPECT_NE(result.error().message().find("--fov"), std::string::npos);
  EXPECT_NE(result.error().message().find("abc"), std::string::npos);
}

TEST(Parse, a_comma_locale_changes_nothing) {
  // Where the locale is not installed the call fails and the test shows what it shows without it.
  std::setlocale(LC_ALL, "de_DE.UTF-8");
  EXPECT_EQ(parseNumber("1.5", "--x").value(), 1.5);
  EXPECT_FALSE(parseNumber("1,5", "--x").ok());
  std::setlocale(LC_ALL, "C");
}

TEST(Parse, integers_are_whole_and_within_their_range) {
  EXPECT_EQ(parseInteger("64", "-j", 1, 64).value(), 64);
  EXPECT_EQ(parseInteger("1", "-j", 1, 64).value(), 1);
  for (const char* text : {"0", "65", "1.0", "", "9223372036854775808", "x"}) {
    EXPECT_FALSE(parseInteger(text, "-j", 1, 64).ok()) << text;
  }
}

TEST(Parse, eyes_stand_above_the_datum_or_above_ground) {
  const EyePosition absolute = parseEye("46.5,-121.75,1200.5", "--eye").value();
  EXPECT_EQ(absolute.latitude, 46.5);
  EXPECT_EQ(absolute.longitude, -121.75);
  EXPECT_EQ(absolute.altitude, 1200.5);
  EXPECT_FALSE(absolute.above_ground);
  EXPECT_TRUE(parseEye("46.5,-121.75,120agl", "--eye").value().above_ground);
  EXPECT_EQ(parseEye("-90,360,-5agl", "--eye").value().altitude, -5);
  for (const char* text : {"46,7", "46,7,1,2", "90.1,7,1", "46,-180.5,1", "46,360.5,1", "46,7,agl",
                           "46,7,1AGL", "46,7,1 agl", ",,"}) {
    EXPECT_FALSE(parseEye(text, "--eye").ok()) << text;
  }
}

TEST(Parse, directions_have_two_or_three_numbers) {
  const LookDirection look = parseLook("90,-30,5", "--look").value();
  EXPECT_EQ(look.heading, 90);
  EXPECT_EQ(look.pitch, -30);
  EXPECT_EQ(look.roll, 5);
  EXPECT_EQ(parseLook("0,90", "--look").value().roll, 0);
  for (const char* text : {"1", "1,2,3,4", "0,90.5", "361,0"})
    EXPECT_FALSE(parseLook(text, "--look").ok()) << text;
  EXPECT_EQ(parseSun("225,-5", "--sun").value().elevation, -5);
  EXPECT_FALSE(parseSun("225", "--sun").ok());
}

TEST(Parse, sizes_are_two_whole_numbers) {
  EXPECT_EQ(parseSize("640x480", "--size").value().width, 640);
  EXPECT_EQ(parseSize("1x16384", "--size").value().height, kMaximumPictureSide);
  for (const char* text : {"640", "640x", "x480", "640X480", "0x1", "16385x1", "-1x1", "1x1x1", "1.5x2"}) {
    EXPECT_FALSE(parseSize(text, "--size").ok()) << text;
  }
}

TEST(Parse, bounds_may_cross_the_antimeridian) {
  const GeodeticBounds plain = parseBounds("-122,46,-121,47", "--bounds").value();
  EXPECT_EQ(plain.east, -121);
  const GeodeticBounds crossing = parseBounds("179,-10,-179,10", "--bounds").value();
  EXPECT_EQ(crossing.west, 179);
  EXPECT_EQ(crossing.east, 181);
  for (const char* text : {"1,2,3", "0,0,0,1", "0,1,1,1", "0,2,1,1", "0,-91,1,1"}) {
    EXPECT_FALSE(parseBounds(text, "--bounds").ok()) << text;
  }
}

TEST(Parse, a_quantum_is_exact) {
  EXPECT_EQ(parseQuantum("0.01", "--quantum").value(), (Rational{1, 100}));
  EXPECT_EQ(parseQuantum("381/1250", "--quantum").value(), (Rational{381, 1250}));
  EXPECT_EQ(parseQuantum("0.3048", "--quantum").value(), (Rational{381, 1250}));
  EXPECT_EQ(parseQuantum("2.5", "--quantum").value(), (Rational{5, 2}));
  for (const char* const wrong :
       {"", "0", "-1", "1e-2", "1/0", "0/1", "1.2.3", "/", "1/", "nan", "2000", "0.0000001", "1 ", "."})
    EXPECT_EQ(parseQuantum(wrong, "--quantum").error().kind, ErrorKind::kUsage) << wrong;
}

TEST(Parse, a_spacing_has_a_unit) {
  EXPECT_TRUE(parseSpacing("1as", "--spacing").value().arc_seconds);
  EXPECT_EQ(parseSpacing("1/3as", "--spacing").value().value, 1.0 / 3);
  EXPECT_EQ(parseSpacing("30m", "--spacing").value().value, 30);
  EXPECT_FALSE(parseSpacing("0.5m", "--spacing").value().arc_seconds);
  for (const char* const wrong : {"", "30", "m", "as", "-1as", "0m", "1e3m", "1km", "1000000as"})
    EXPECT_EQ(parseSpacing(wrong, "--spacing").error().kind, ErrorKind::kUsage) << wrong;
}

TEST(Parse, a_stored_value_may_be_nan) {
  EXPECT_EQ(parseStoredValue("-9999", "--nodata").value(), -9999);
  EXPECT_TRUE(std::isnan(parseStoredValue("nan", "--nodata").value()));
  EXPECT_FALSE(parseStoredValue("none", "--nodata").ok());
  EXPECT_FALSE(parseStoredValue("inf", "--nodata").ok());
}

}  // namespace
}  // namespace deltaz
