// How far off each transform of transform_posts.h may be: a proved bound, in every rounding mode, with and
// without denormals.
//
// With u = 2^-23 (twice the rounding error of the nearest mode, the error of the others), g(n) =
// n u / (1 - n u), d the distance from the eye to the tile's middle, w half the width plus half the height of
// the flat grid, k the largest height above the base, P = planarityBound:
//   exact   E = sqrt(3) 2^-52 (24 |post| + 8 |eye|)
//   local   sqrt(3) g(6) (w + k + P) + g(2) d + E    offset: conversion, matrix entry, product, three sums;
//                                                    translation: conversion and one sum
//   matrix  g(8) (w + k) + g(2) d + P + E            as local, heights three roundings more; no root because
//                                                    each axis' error is bounded by that axis as a vector
//   delta   g(8) (w + k0) + g(2) d                   the first post, k0 its height above the base
//           + g(2) 2 w + g(6) s                      axes and increments, s the longest sum of |delta-z|
//           + g(n + 1) (d + w + k0 + s) + P + E      n running sums on the longest way to a post
// Each line counts how many roundings a term passes through. E for a geodetic grid: a and c carry at most 8,
// b h and s h 3, the column term 5, products and sums 4; t = dot(m, eye) 5; one each to spare. A projected
// grid's 25 control points and their weights make it 256 instead of 24. The view matrix is taken as it is:
// orthogonal to rounding.
// Thread-safety: pure function.
#pragma once

#include <vector>

#include "librender/objects/transform_posts.h"

namespace deltaz {

// The distance in metres, in space, that no valid post of the tile is farther off than: with (du, dv, dw) the
// error of its view coordinates, |(du, dv / pixels, dw / pixels)|. Infinity where single precision overflows.
// Cost: a pass over the tile's heights.
double transformErrorBound(TransformKind kind, const TerrainTile& tile, const GridGeometry& geometry,
                           const ViewTransform& view);

// The same on the picture: pixels that no visible point of the tile's faces is farther off than, when no post
// is off by more than `metres`. `position` are the tile's posts as they are drawn. With q a drawn point at
// depth D and p the true one, |p / p.u - q / q.u| <= metres sqrt(1 + t^2) / (D - metres), t the largest
// tangent in the picture; D is at least the hither plane's, that of the tile's nearest post, and what follows
// from the distance of its nearest post: no point of a face with edges up to L is farther than L / sqrt(3)
// from a post. Infinity if D may be within `metres` of the eye.
double transformPixelBound(double metres, const TerrainTile& tile, const std::vector<Vector3>& position,
                           const ViewTransform& view);

}  // namespace deltaz
