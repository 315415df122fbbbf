/// Machine files and settings, up to the checked configuration.
#include <string_view>

#include "pipeline/machine/machine_config.h"
#include "tests/fuzz/refusal.h"
#include "tests/fuzz/targets.h"

namespace quadrille::fuzz {
namespace {

void set(pipeline::MachineConfig& config, std::string_view line) {
  const std::size_t equals = line.find('=');
  if (equals == std::string_view::npos) return;
  done_or_refused("--set", [&] { config.set(line.substr(0, equals), line.substr(equals + 1), "--set"); });
}

}  // namespace

void run_machine(Bytes bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  pipeline::MachineConfig from_file, from_flags;
  done_or_refused("m.toml", [&] { pipeline::apply_machine_text(from_file, text, "m.toml"); });
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    set(from_flags, text.substr(begin, end - begin));
    begin = end + 1;
  }
  done_or_refused("machine", [&] { from_flags.check(); });
}

}  // namespace quadrille::fuzz
