// Takes files of a database with blocks of several types apart, lets a test change them, and puts them
// together again with every length, identity, checksum and hash right.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "formats/area.h"
#include "formats/color_file.h"
#include "formats/container.h"
#include "formats/model_file.h"
#include "formats/placement_file.h"
#include "tests/support/memory_file_system.h"

namespace deltaz {

struct AssetBlock {
  BlockType type = BlockType::kColorTile;
  std::vector<std::byte> payload;
};

// All of these work on the database at kMemoryDatabasePath and throw std::runtime_error if it is not sound.
AreaHeader areaOf(const MemoryFileSystem& files);
void setArea(MemoryFileSystem& files, const AreaHeader& area);
// Path of the file of a role and number.
std::string assetPath(const MemoryFileSystem& files, FileRole role, std::uint32_t number = 0);
void changeAsset(MemoryFileSystem& files, FileRole role, std::uint32_t number,
                 const std::function<void(std::vector<AssetBlock>&)>& change);

// The first colour map, as values.
struct ColorParts {
  std::vector<std::vector<std::byte>> tiles;  // by block
  std::vector<ColorNode> nodes;               // record n is nodes[n - 1]
  ColorDirectory directory;

  std::vector<std::uint8_t> texels(const ColorNode& node) const;
  void setTexels(const ColorNode& node, const std::vector<std::uint8_t>& texels);
  // The node at a place beside another one of its level; none if there is none.
  const ColorNode* beside(const ColorNode& node, int dx, int dy) const;
};
void changeColors(MemoryFileSystem& files, const std::function<void(ColorParts&)>& change);

// The first model.
struct ModelParts {
  std::vector<ModelMesh> meshes;  // by block
  ModelTree tree;
};
void changeModel(MemoryFileSystem& files, const std::function<void(ModelParts&)>& change);

struct PlacementParts {
  std::vector<std::vector<Placement>> pages;
  PlacementDirectory directory;
};
void changePlacements(MemoryFileSystem& files, const std::function<void(PlacementParts&)>& change);

}  // namespace deltaz
