// Damage of every kind to every byte of a small real database: the check at level checksum always reports it,
// and the reader gives an error or exactly the right posts. Nothing here re-seals a checksum unless it says
// so.
#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <functional>
#include <gtest/gtest.h>
#include <iostream>
#include <mutex>
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <string>
#include <vector>

#include "libdb/access/database.h"
#include "libdb/check/check.h"
#include "libdb/export/export_terrain.h"
#include "libdb/source/elevation_source.h"
#include "tests/support/bit_flips.h"
#include "tests/support/container_surgery.h"
#include "tests/support/database_editor.h"
#include "tests/support/synthetic_grid.h"

namespace deltaz {
namespace {

const std::string kPath = kMemoryDatabasePath;

struct Subject {
  std::string name;
  MemoryFileSystem files;
  std::vector<RawGrid> levels;  // what reading must give
  std::vector<std::string> paths;
};

std::vector<RawGrid> readLevels(const Database& database) {
  std::vector<RawGrid> levels;
  for (int level = 0; level < database.grid(0).header().level_count; ++level) {
    auto grid = readGrid(database, 0, level);
    if (!grid.ok()) return {};
    levels.push_back(std::move(grid).value());
  }
  return levels;
}

Subject makeSubject() {
  Subject subject;
  SyntheticGridOptions gentle;  // packs to about the size of n43.dt0
  gentle.highest = 300;
  RawGrid grid = syntheticGrid(gentle);
  subject.name = "synthetic 121 x 121";
  if (const char* folder = std::getenv("DELTAZ_TEST_DATA"); folder != nullptr && *folder != '\0') {
    auto real = readElevationSource(std::string(folder) + "/dem/n43.dt0", {});
    if (real.ok()) {
      grid = std::move(real).value();
      subject.name = "n43.dt0";
    }
  }
  subject.files = buildInMemory(grid);
  for (const std::string& path : subject.files.paths()) {
    if (baseName(path) != kLockFileName) subject.paths.push_back(path);
  }
  auto database = Database::open(subject.files, kPath);
  if (database.ok()) subject.levels = readLevels(database.value());
  return subject;
}

const Subject& subject() {
  static const Subject kSubject = makeSubject();
  return kSubject;
}

bool samePosts(const RawGrid& a, const RawGrid& b) {
  if (a.heights.size() != b.heights.size() || a.valid != b.valid) return false;
  for (std::size_t i = 0; i < a.heights.size(); ++i) {
    if ((a.valid.empty() || a.valid[i] != 0) && a.heights[i] != b.heights[i]) return false;
  }
  return true;
}

// Whether reading everything gives an error or exactly the right posts.
bool readerIsHonest(const FileSystem& files) {
  const auto database = Database::open(files, kPath);
  if (!database.ok()) return true;
  if (database.value().grid(0).header() != subject().levels[0].header) return false;
  for (std::size_t level = 0; level < subject().levels.size(); ++level) {
    const auto grid = readGrid(database.value(), 0, static_cast<int>(level));
    if (!grid.ok()) return true;
    if (!samePosts(grid.value(), subject().levels[level])) return false;
  }
  return true;
}

bool isReported(const FileSystem& files, CheckLevel level) {
  CheckOptions options;
  options.level = level;
  options.threads = 1;  // the damages themselves are spread over the threads
  return checkDatabase(files, kPath, options).count(Severity::kError) > 0;
}

// Applies damage(files, i) for 0 <= i < count, each to a sound copy of the database, and judges check and
// reader.
class Trial {
 public:
  explicit Trial(std::string what) : what_(std::move(what)) {}

  void run(std::size_t count, CheckLevel level,
           const std::function<void(MemoryFileSystem&, std::size_t)>& damage) {
    oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<std::size_t>(0, count, 64), [&](const auto& range) {
      for (std::size_t i = range.begin(); i != range.end(); ++i) {
        MemoryFileSystem files = subject().files;
        damage(files, i);
        judge(files, level, std::to_string(i));
      }
    });
  }

  void judge(const MemoryFileSystem& files, CheckLevel level, const std::string& which) {
    ++trials_;
    if (!isReported(files, level)) complain("not reported", which);
    if (!readerIsHonest(files)) complain("read as wrong data", which);
  }

  ~Trial() {
    std::cout << "[  FIGURE  ] " << subject().name << ": " << what_ << ": " << trials_ << " trials, "
              << failures_ << " undetected\n";
    EXPECT_EQ(failures_, 0u) << what_ << ": first " << first_;
    EXPECT_GT(trials_, 0u);
  }

 private:
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

CheckLevel levelFor(const std::string& path) {
  return baseName(path) == kAreaFileName ? CheckLevel::kStructure : CheckLevel::kChecksum;
}

std::string terrainPath() {
  MemoryFileSystem files = subject().files;
  return DatabaseEditor(files, kPath).terrainPath();
}

class Damage : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(subject().paths.size(), 3u);
    ASSERT_FALSE(subject().levels.empty());
    ASSERT_FALSE(isReported(subject().files, CheckLevel::kDecode));
  }
};

TEST_F(Damage, every_flipped_bit_is_reported_and_never_read_as_data) {
  for (const std::string& path : subject().paths) {
    const std::size_t flips = subject().files.bytes(path).size() * flipsOfByte();
    Trial(baseName(path) + ", bits of every byte flipped")
        .run(flips, levelFor(path),
             [&](MemoryFileSystem& files, std::size_t n) { files.flipBit(path, flippedBit(n)); });
  }
}

TEST_F(Damage, every_truncation_is_reported_and_never_read_as_data) {
  for (const std::string& path : subject().paths) {
    const std::size_t size = subject().files.bytes(path).size();
    Trial(baseName(path) + ", cut at every length")
        .run(size, levelFor(path),
             [&](MemoryFileSystem& files, std::size_t length) { files.mutableBytes(path).resize(length); });
  }
}

TEST_F(Damage, appended_bytes_are_reported) {
  for (const std::string& path : subject().paths) {
    Trial(baseName(path) + ", 1 to 64 bytes appended")
        .run(128, levelFor(path), [&](MemoryFileSystem& files, std::size_t i) {
          FileBytes& bytes = files.mutableBytes(path);
          bytes.resize(bytes.size() + i / 2 + 1, i % 2 == 0 ? std::byte{0} : std::byte{0xA5});
        });
  }
}

TEST_F(Damage, zeroed_ranges_are_reported) {
  constexpr std::size_t kRange = 4096;
  for (const std::string& path : subject().paths) {
    const std::size_t size = subject().files.bytes(path).size();
    Trial(baseName(path) + ", 4 KiB zeroed from every 256th byte on")
        .run((size + 255) / 256, levelFor(path), [&](MemoryFileSystem& files, std::size_t i) {
          FileBytes& bytes = files.mutableBytes(path);
          const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(i * 256);
          std::fill(begin, begin + static_cast<std::ptrdiff_t>(std::min(kRange, size - i * 256)),
                    std::byte{0});
        });
  }
}

// Calls damage(files, a, b) for every pair of the terrain file's blocks.
void forEveryPair(Trial& trial, const std::function<bool(FileBytes&, std::uint32_t, std::uint32_t)>& damage) {
  const std::string path = terrainPath();
  const std::uint32_t blocks = blockCount(subject().files.bytes(path));
  for (std::uint32_t a = 0; a < blocks; ++a) {
    for (std::uint32_t b = a + 1; b < blocks; ++b) {
      MemoryFileSystem files = subject().files;
      if (!damage(files.mutableBytes(path), a, b)) continue;
      trial.judge(files, CheckLevel::kChecksum, std::to_string(a) + " and " + std::to_string(b));
    }
  }
}

TEST_F(Damage, swapped_payloads_are_reported) {
  Trial trial("every two blocks' payloads swapped");
  forEveryPair(trial, [](FileBytes& file, std::uint32_t a, std::uint32_t b) {
    const BlockLocation first = entryOf(file, a), second = entryOf(file, b);
    const auto length = static_cast<std::ptrdiff_t>(std::min(first.length, second.length));
    const auto from = file.begin() + static_cast<std::ptrdiff_t>(first.offset);
    const FileBytes before = file;
    std::swap_ranges(from, from + length, file.begin() + static_cast<std::ptrdiff_t>(second.offset));
    return file != before;
  });
}

TEST_F(Damage, swapped_index_entries_under_a_valid_page_checksum_are_reported) {
  Trial trial("every two index entries swapped, page sealed");
  forEveryPair(trial, [](FileBytes& file, std::uint32_t a, std::uint32_t b) {
    const BlockLocation first = entryOf(file, a), second = entryOf(file, b);
    storeEntry(file, a, second);
    storeEntry(file, b, first);
    sealIndexPages(file);
    return true;
  });
}

TEST_F(Damage, entries_that_point_at_another_block_under_a_valid_page_checksum_are_reported) {
  Trial trial("every entry pointed at every other block, page sealed");
  forEveryPair(trial, [](FileBytes& file, std::uint32_t a, std::uint32_t b) {
    storeEntry(file, a, entryOf(file, b));
    sealIndexPages(file);
    return true;
  });
}

TEST_F(Damage, blocks_and_files_of_another_database_are_reported) {
  RawGrid other = subject().levels[0];
  for (std::size_t i = 0; i < other.heights.size(); ++i) other.heights[i] += i % 3 == 0 ? 1 : 0;
  MemoryFileSystem foreign_files = buildInMemory(other);
  const std::string path = terrainPath();
  const FileBytes foreign = foreign_files.bytes(path);
  {
    Trial trial("blocks of another database spliced in, page sealed");
    for (std::uint32_t number = 0; number < blockCount(foreign); ++number) {
      MemoryFileSystem files = subject().files;
      FileBytes& file = files.mutableBytes(path);
      const std::vector<std::byte> payload = payloadOf(foreign, number);
      BlockLocation entry = entryOf(file, number);
      const std::size_t room = (entry.length + kBlockAlignment - 1) / kBlockAlignment * kBlockAlignment;
      if (payload.size() > room) continue;
      std::fill_n(file.begin() + static_cast<std::ptrdiff_t>(entry.offset), room, std::byte{0});
      std::copy(payload.begin(), payload.end(), file.begin() + static_cast<std::ptrdiff_t>(entry.offset));
      entry.length = static_cast<std::uint32_t>(payload.size());
      entry.checksum = entryOf(foreign, number).checksum;
      storeEntry(file, number, entry);
      sealIndexPages(file);
      if (file == subject().files.bytes(path)) continue;
      trial.judge(files, CheckLevel::kChecksum, std::to_string(number));
    }
  }
  Trial trial("a whole file of another database");
  for (const std::string& name : subject().paths) {
    if (baseName(name) == kAreaFileName) continue;
    MemoryFileSystem files = subject().files;
    if (files.bytes(name) == foreign_files.bytes(name)) continue;
    files.setBytes(name, foreign_files.bytes(name));
    trial.judge(files, CheckLevel::kStructure, name);
  }
}

}  // namespace
}  // namespace deltaz
