// The content digest: a Merkle hash of what a database says, whatever the bytes are that say it. Two
// databases have the same digest when their decoded heights and voids, the definition of their normals, their
// errors, bounds, seams and the shape of their trees are the same; file layout, file ids, compression and
// provenance do not enter. So a patched, merged or resumed database must equal a fresh build in it.
//
// Cost: decodes the whole database once; memory one node per level. Errors: whatever reading reports.
// Thread-safety: pure function.
#pragma once

#include "formats/hash.h"
#include "libdb/access/database.h"

namespace deltaz {

Result<Hash128> contentDigest(const Database& database);

}  // namespace deltaz
