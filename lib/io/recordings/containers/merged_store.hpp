#pragma once

#include "recordings/containers/message_store.hpp"

namespace cmap {

/// Several files as one, by log time; those of equal times in the order of the files.
std::unique_ptr<MessageStore> merge_stores(std::vector<std::unique_ptr<MessageStore>> parts);

}  // namespace cmap
