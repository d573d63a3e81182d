// Damage of every kind to every byte of a colour map, a model and placements, and every operation on the file
// system that can fail: the check always reports it, and the reader gives an error or exactly what was
// stored.
#include <atomic>
#include <functional>
#include <gtest/gtest.h>
#include <iostream>
#include <mutex>
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <optional>
#include <string>
#include <vector>

#include "formats/hash.h"
#include "libdb/access/database.h"
#include "libdb/check/check.h"
#include "tests/support/asset_editor.h"
#include "tests/support/bit_flips.h"
#include "tests/support/container_surgery.h"
#include "tests/support/fault_file_system.h"
#include "tests/support/furnished_area.h"
#include "tests/support/synthetic_grid.h"

namespace deltaz {
namespace {

const std::string kPath = kMemoryDatabasePath;

// A hash of all that readers get of colour maps, models and placements; nothing if any of it is refused.
std::optional<Hash128> contentsOf(const FileSystem& files) {
  const auto database = Database::open(files, kPath);
  if (!database.ok()) return std::nullopt;
  std::vector<std::byte> all;
  const auto take = [&](const std::vector<std::byte>& bytes) {
    all.insert(all.end(), bytes.begin(), bytes.end());
  };
  for (const Model& model : database.value().models()) {
    take(encodeModelTree(model.tree()));
    for (const ModelPart& part : model.tree().parts) {
      for (const ModelLod& lod : part.lods) {
        const auto mesh = model.mesh(lod);
        if (!mesh.ok()) return std::nullopt;
        take(encodeModelMesh(mesh.value()));
      }
    }
  }
  if (const PlacementSet* set = database.value().placements(); set != nullptr) {
    take(encodePlacementDirectory(set->directory()));
    const auto placements = set->all();
    if (!placements.ok()) return std::nullopt;
    take(encodePlacementPage(placements.value()));
  }
  // Last, since texels take the longest, and most damage is found before.
  for (const ColorMap& map : database.value().colorMaps()) {
    take(encodeColorDirectory(map.directory()));
    for (std::uint32_t number = 1; number <= map.directory().node_count; ++number) {
      const auto node = map.record(number);
      if (!node.ok()) return std::nullopt;
      take(encodeColorPage(std::span(&node.value(), 1)));
      const auto texels = map.tile(node.value());
      if (!texels.ok()) return std::nullopt;
      const auto bytes = std::as_bytes(std::span(texels.value()));
      all.insert(all.end(), bytes.begin(), bytes.end());
    }
  }
  return hash128(all);
}

const Hash128& soundContents() {
  static const Hash128 kContents = contentsOf(furnishedArea()).value();
  return kContents;
}

bool isReported(const FileSystem& files, CheckLevel level) {
  CheckOptions options;
  options.level = level;
  options.threads = 1;  // the damages themselves are spread over the threads
  return checkDatabase(files, kPath, options).count(Severity::kError) > 0;
}

class Trial {
 public:
  explicit Trial(std::string what) : what_(std::move(what)) {}

  // Applies damage(files, i) for 0 <= i < count, each to a sound copy; false: it changed nothing.
  void run(std::size_t count, const std::function<bool(MemoryFileSystem&, std::size_t)>& damage) {
    oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<std::size_t>(0, count, 64), [&](const auto& range) {
      for (std::size_t i = range.begin(); i != range.end(); ++i) {
        MemoryFileSystem files = furnishedArea();
        if (damage(files, i)) judge(files, std::to_string(i));
      }
    });
  }

  ~Trial() {
    std::cout << "[  FIGURE  ] " << what_ << ": " << trials_ << " trials, " << failures_ << " undetected\n";
    EXPECT_EQ(failures_, 0u) << what_ << ": first " << first_;
    EXPECT_GT(trials_, 0u);
  }

 private:
  void judge(const MemoryFileSystem& files, const std::string& which) {
    ++trials_;
    const auto read = contentsOf(files);
    if (read && *read != soundContents()) complain("read as wrong data", which);
    if (!isReported(files, CheckLevel::kChecksum)) complain("not reported", which);
  }

  void complain(const std::string& how, const std::string& which) {
    const std::lock_guard guard(mutex_);
    if (failures_++ == 0) first_ = which + ": " + how;
  }

  std::string what_;
  std::atomic<std::size_t> trials_ = 0;
  std::mutex mutex_;
  std::size_t failures_ = 0;
  std::string first_;
};

class FurnishedDamage : public testing::TestWithParam<FileRole> {
 protected:
  void SetUp() override {
    path_ = assetPath(furnishedArea(), GetParam());
    ASSERT_FALSE(isReported(furnishedArea(), CheckLevel::kGeometry));
  }
  const FileBytes& bytes() const { return furnishedArea().bytes(path_); }
  std::string named(const char* what) const { return baseName(path_) + ", " + what; }

  // Calls damage(file, a, b) for every pair of blocks.
  void forEveryPair(Trial& trial,
                    const std::function<void(FileBytes&, std::uint32_t, std::uint32_t)>& damage) const {
    const std::uint32_t blocks = blockCount(bytes());
    ASSERT_GT(blocks, 1u);
    trial.run(std::size_t{blocks} * blocks, [&](MemoryFileSystem& files, std::size_t i) {
      const auto a = static_cast<std::uint32_t>(i / blocks), b = static_cast<std::uint32_t>(i % blocks);
      if (a >= b) return false;
      damage(files.mutableBytes(path_), a, b);
      return files.bytes(path_) != bytes();
    });
  }

  std::string path_;
};

TEST_P(FurnishedDamage, every_flipped_bit_is_reported_and_never_read_as_data) {
  const std::size_t flips = bytes().size() * flipsOfByte();
  Trial(named("bits of every byte flipped")).run(flips, [&](MemoryFileSystem& files, std::size_t n) {
    files.flipBit(path_, flippedBit(n));
    return true;
  });
}

TEST_P(FurnishedDamage, every_truncation_is_reported_and_never_read_as_data) {
  Trial(named("cut at every length")).run(bytes().size(), [&](MemoryFileSystem& files, std::size_t length) {
    files.mutableBytes(path_).resize(length);
    return true;
  });
}

TEST_P(FurnishedDamage, appended_bytes_are_reported) {
  Trial(named("1 to 64 bytes appended")).run(128, [&](MemoryFileSystem& files, std::size_t i) {
    FileBytes& file = files.mutableBytes(path_);
    file.resize(file.size() + i / 2 + 1, i % 2 == 0 ? std::byte{0} : std::byte{0xA5});
    return true;
  });
}

TEST_P(FurnishedDamage, swapped_payloads_are_reported) {
  Trial trial(named("every two blocks' payloads swapped"));
  forEveryPair(trial, [](FileBytes& file, std::uint32_t a, std::uint32_t b) {
    const BlockLocation first = entryOf(file, a), second = entryOf(file, b);
    const auto length = static_cast<std::ptrdiff_t>(std::min(first.length, second.length));
    const auto from = file.begin() + static_cast<std::ptrdiff_t>(first.offset);
    std::swap_ranges(from, from + length, file.begin() + static_cast<std::ptrdiff_t>(second.offset));
  });
}

TEST_P(FurnishedDamage, swapped_index_entries_under_a_valid_page_checksum_are_reported) {
  Trial trial(named("every two index entries swapped, page sealed"));
  forEveryPair(trial, [](FileBytes& file, std::uint32_t a, std::uint32_t b) {
    const BlockLocation first = entryOf(file, a), second = entryOf(file, b);
    storeEntry(file, a, second);
    storeEntry(file, b, first);
    sealIndexPages(file);
  });
}

INSTANTIATE_TEST_SUITE_P(Files, FurnishedDamage,
                         testing::Values(FileRole::kColors, FileRole::kModel, FileRole::kPlacements),
                         [](const auto& information) {
                           return std::string(fileRoleName(information.param));
                         });

class FurnishedIoFault : public testing::TestWithParam<FaultMode> {
 protected:
  static void forEveryOperation(const char* what,
                                const std::function<void(const FaultFileSystem&)>& attempt) {
    std::uint64_t operation = 1;
    for (; operation < 100000; ++operation) {
      const FaultFileSystem faulty(furnishedArea(), operation, GetParam());
      attempt(faulty);
      if (testing::Test::HasFailure()) FAIL() << what << ": operation " << operation;
      if (!faulty.failed()) break;
    }
    EXPECT_GT(operation, 20u);
    std::cout << "[  FIGURE  ] furnished, " << what << ": " << operation - 1
              << " operations failed one by one\n";
  }
};

TEST_P(FurnishedIoFault, reading_gives_an_error_or_what_was_stored) {
  forEveryOperation("read", [](const FaultFileSystem& faulty) {
    const auto read = contentsOf(faulty);
    EXPECT_EQ(read.value_or(soundContents()), soundContents());
    EXPECT_TRUE(read.has_value() || faulty.failed());
  });
}

TEST_P(FurnishedIoFault, check_never_calls_valid_what_it_could_not_read) {
  CheckOptions options;
  options.level = CheckLevel::kGeometry;
  options.threads = 1;
  forEveryOperation("check", [&](const FaultFileSystem& faulty) {
    const Report report = checkDatabase(faulty, kPath, options);
    if (!faulty.failed()) {
      EXPECT_TRUE(report.complete && report.groups.empty());
      return;
    }
    EXPECT_FALSE(report.complete);
    EXPECT_GT(report.count(Severity::kError), 0u);
    ASSERT_TRUE(report.fatal.has_value());
    EXPECT_EQ(report.fatal->kind, ErrorKind::kCannotAccess) << report.fatal->message();
  });
}

INSTANTIATE_TEST_SUITE_P(Modes, FurnishedIoFault, testing::Values(FaultMode::kOnce, FaultMode::kFromThenOn),
                         [](const auto& information) {
                           return information.param == FaultMode::kOnce ? "once" : "from_then_on";
                         });

}  // namespace
}  // namespace deltaz
