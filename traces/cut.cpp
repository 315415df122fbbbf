#include "traces/cut.h"

#include <algorithm>

#include "models/base/error.h"

namespace quadrille::traces {
namespace {

template <class T>
std::uint32_t count(const CommandStream& stream) {
  return static_cast<std::uint32_t>(std::ranges::count_if(
      stream.commands, [](const Command& command) { return std::holds_alternative<T>(command); }));
}

}  // namespace

void end_with_pass(CommandStream& stream, std::uint32_t last) {
  const std::uint32_t passes = count<EndPass>(stream);
  if (last < 1 || last > passes)
    throw user_error("pass {} of a frame of {}; legal are 1 to {}", last, passes, passes);
  std::uint32_t ended = 0;
  const auto end = std::ranges::find_if(stream.commands, [&](const Command& command) {
    return std::holds_alternative<EndPass>(command) && ++ended == last;
  });
  stream.commands.erase(end + 1, stream.commands.end());
}

void keep_draws(CommandStream& stream, std::uint32_t first, std::uint32_t last) {
  const std::uint32_t draws = count<Draw>(stream);
  if (first > last || last >= draws)
    throw user_error("draws {}..{} of a frame of {}; legal are 0..0 to 0..{}", first, last, draws,
                     draws == 0 ? 0 : draws - 1);
  std::uint32_t number = 0;
  std::erase_if(stream.commands, [&](const Command& command) {
    if (!std::holds_alternative<Draw>(command)) return false;
    const std::uint32_t n = number++;
    return n < first || n > last;
  });
}

}  // namespace quadrille::traces
