#include "recordings/containers/sqlite_store.hpp"

namespace cmap {

std::unique_ptr<MessageStore> open_sqlite(const std::filesystem::path& path) {
  throw UnsupportedError(path.string() +
                         ": an SQLite recording; this build of cmap cannot read it (apt-get install libsqlite3-dev, "
                         "and build again)");
}

}  // namespace cmap
