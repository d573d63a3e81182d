// Every block against its checksum, every file's identity against its contents, every padding byte against
// zero.
#include "formats/bytes.h"
#include "libdb/check/check_context.h"
#include "libdb/check/parallel_report.h"
#include "libdb/check/report_detail.h"

namespace deltaz {
namespace {

void checkFile(CheckContext& context, CheckedFile& file) {
  const ContainerReader& container = *file.container;
  // One pass over the file serves both: a block's hash is verified by read(), and all of them make the
  // identity.
  std::vector<std::uint64_t> hashes(container.blockCount());
  parallelReport(context.report, container.blockCount(), 16, [&](std::size_t item, Report& report) {
    const auto number = static_cast<std::uint32_t>(item);
    IssueLocation where;
    where.file = file.reference.name;
    where.block = number;
    const auto fail = [&](const Error& error) {
      // The tree rule reads node pages before this one does; what it reported is not counted twice.
      if (file.damaged_blocks[item] == 0) addError(report, error, where);
      file.damaged_blocks[item] = 1;
    };
    const auto location = container.locate(number);
    if (!location.ok()) return fail(location.error());
    where.offset = location.value().offset;
    const auto payload = container.read(number, location.value().type);
    if (!payload.ok()) return fail(payload.error());
    hashes[item] = hash64(payload.value());
    ++report.blocks_checked;
    report.bytes_checked += payload.value().size();
  });
  IssueLocation where;
  where.file = file.reference.name;
  if (const Status padding = container.checkPadding(); !padding.ok())
    addError(context.report, padding.error(), where);
  for (const std::uint8_t damaged : file.damaged_blocks) {
    if (damaged != 0) return;
  }
  ByteWriter writer;
  for (const std::uint64_t hash : hashes) writer.put(hash);
  if (hash128(writer.view()) != container.identity().id) {
    context.report.add(
        makeIssue(IssueCode::kSumFileId, "the file's identity does not follow from its contents", where));
  }
}

}  // namespace

void checkChecksums(CheckContext& context) {
  for (CheckedFile& file : context.listed) {
    if (file.container) checkFile(context, file);
  }
}

}  // namespace deltaz
