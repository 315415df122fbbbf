/// Files that are read at once and appear at once: a reader never sees half of what we write, and an
/// interrupted run leaves the old file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace quadrille::traces {

/// Is given the first 64 bytes of a file, or all of a shorter one, and throws if the rest is not worth
/// reading.
using LookAtBeginning = std::function<void(std::span<const std::byte>)>;

/// All bytes of a regular file of at most `limit` bytes. Throws `UserError` that starts with the path, and
/// what `look` throws.
[[nodiscard]] std::vector<std::byte> read_whole_file(const std::string& path, std::uint64_t limit,
                                                     const LookAtBeginning& look = {});
/// Writes a file by way of a temporary one beside it and a rename; the temporary one is removed on every way
/// out that can be caught (unfinished.h). Throws `UserError` that starts with the path.
void write_whole_file(const std::string& path, std::span<const std::byte> bytes);

}  // namespace quadrille::traces
