// Makes triangles from a file fit to draw and to measure, and says what it did: vertices at one place become
// one, triangles without an area or given twice go, and closed shells whose triangles do not agree on what is
// outside are turned outwards. Thread-safety: pure functions.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "libdb/source/mesh_source.h"

namespace deltaz {

struct RepairReport {
  std::size_t welded_vertices = 0;       // stood where another stood
  std::size_t isolated_vertices = 0;     // belonged to no triangle
  std::size_t degenerate_triangles = 0;  // had no area
  std::size_t duplicate_triangles = 0;   // same corners in the same order round
  std::size_t turned_triangles = 0;
  std::size_t non_manifold_edges = 0;  // of more than two triangles; kept
  std::size_t inside_out_shells = 0;   // closed, agreeing, and facing inwards; kept
  std::size_t open_edges = 0;          // of one triangle; kept

  RepairReport& operator+=(const RepairReport& other);
  // One line for each thing that was changed or that people may want to know; open edges are none.
  std::vector<std::string> lines() const;
};

// May leave a mesh without triangles.
RepairReport repairMesh(ImportedMesh& mesh);

}  // namespace deltaz
