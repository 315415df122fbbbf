/// Files of costs for --energy: damaged, absurd, endless, and none at all.
#include <sys/stat.h>

#include "tests/hostile/hostile_case.h"

namespace quadrille::hostile {
namespace {

std::vector<std::string> charged(const std::string& file) {
  return {"render", "builtin:triangle", "-q", "--size", "16x16", "--energy", file, "--stats", "s.json"};
}

constexpr const char* kConstant =
    "[constants.c]\nlow = 1\ntypical = 2\nhigh = 3\nunit = \"pJ\"\nsource = \"s\"\n";
constexpr const char* kSizes =
    "[[sram]]\nkib = 8\nlow = 1\ntypical = 2\nhigh = 3\nsource = \"s\"\n"
    "[[sram]]\nkib = 9\nlow = 1\ntypical = 2\nhigh = 1e12\nsource = \"s\"\n";

std::string event(const std::string& more) {
  return "[[event]]\nunit = \"core\"\ncounter = \"instructions\"\nwhat = \"w\"\n" + more + "\n";
}

}  // namespace

Group energy_cases() {
  Group group{"files of costs", "types, names, ranges, products and files that are none", {}};
  const auto file = [&](const std::string& what, const std::string& text, Expect expect = Expect::kRefused) {
    group.cases.push_back({what, charged("e.toml"), "e.toml",
                           [=](const fs::path& folder) { write_file(folder / "e.toml", text); }, expect});
  };
  file("empty", "", Expect::kRendered);
  file("a plain one", kConstant + event("cost = \"c\""), Expect::kRendered);
  file("zero bytes", std::string(1000, '\0'));
  file("binary",
       "\x7f"
       "ELF\x01\x02\xff\xfe");
  file("a machine file", "[gpu]\ncores = 1\n");
  for (const std::string value : {"-1", "1e13", "nan", "inf", "-inf", "true", "\"1\"", "[1]", "{}",
                                  "1979-05-27", "99999999999999999999", "", "1 2"})
    for (const std::string key : {"low", "typical", "high"}) {
      std::string text = kConstant;
      const std::size_t at = text.find(key + " = ");
      text.replace(at, text.find('\n', at) - at, key + " = " + value);
      file(key + " = " + value, text);
    }
  file("constants that are a number", "constants = 1\n");
  file("a constant that is a list", "[constants]\nc = [1]\n");
  file("a constant called sram",
       "[constants.sram]\nlow = 1\ntypical = 1\nhigh = 1\nunit = \"pJ\"\nsource = \"s\"\n");
  file("events that are a table", "[event]\nunit = \"core\"\n");
  file("events that are numbers", "event = [1, 2]\n");
  file("an event of nothing", "[[event]]\n");
  file("an event without a cost", event(""));
  file("an event of an unknown cost", event("cost = \"d\""));
  file("times without end", kConstant + event("cost = \"c\"\ntimes = 1e12"), Expect::kRendered);
  file("a memory without sizes", event("cost = \"sram\"\nbytes = [1]"));
  file("a memory beyond all sizes", kSizes + event("cost = \"sram\"\nbytes = [1e12]"));
  file("a memory of half a byte", kSizes + event("cost = \"sram\"\nbytes = [0.5]"), Expect::kRendered);
  file("sizes that all cost nothing",
       "[[sram]]\nkib = 8\nlow = 0\ntypical = 0\nhigh = 0\nsource = \"s\"\n[[sram]]\nkib = 9\nlow = "
       "0\ntypical = "
       "0\nhigh = 0\nsource = \"s\"\n" +
           event("cost = \"sram\"\nbytes = [1e12]"),
       Expect::kRendered);
  file("a size of nothing", "[[sram]]\nkib = 0\nlow = 1\ntypical = 2\nhigh = 3\nsource = \"s\"\n");
  file("a product of 100,000 numbers",
       kSizes + event("cost = \"sram\"\nbytes = [" + repeated("9,\n", 100000) + "9]"));
  file(
      "10,000 constants",
      [] {
        std::string text;
        for (int i = 0; i < 10000; ++i)
          text +=
              "[constants.c" + std::to_string(i) + "]\nlow=1\ntypical=1\nhigh=1\nunit=\"pJ\"\nsource=\"\"\n";
        return text;
      }(),
      Expect::kRendered);
  file("5,000 events", kConstant + repeated(event("cost = \"c\""), 5000), Expect::kRendered);
  file("words between braces", event("cost = \"{gpu.cores}\""));
  file("half a brace", event("cost = \"{\""));
  file("a unit with a line break",
       "[[event]]\nunit = \"co\\nre\"\ncounter = \"x\"\nwhat = \"w\"\ncost = \"c\"\n");
  file("text that is HTML",
       "[constants.c]\nlow = 1\ntypical = 2\nhigh = 3\nunit = \"pJ\"\nsource = \"</script><b>\"\n" +
           event("cost = \"c\""),
       Expect::kRendered);
  file("a line of 2,000 bytes", "# " + std::string(2000, 'x'));
  file("100,000 brackets", "a = " + std::string(100000, '['));
  file("a megabyte of blanks", std::string(1 << 20, ' '));
  const auto special = [&](const std::string& what, const std::function<void(const fs::path&)>& prepare) {
    group.cases.push_back({what, charged("e.toml"), "e.toml",
                           [=](const fs::path& f) { prepare(f / "e.toml"); }, Expect::kRefused});
  };
  special("missing", [](const fs::path&) {});
  special("a folder", [](const fs::path& p) { fs::create_directory(p); });
  special("a pipe", [](const fs::path& p) { mkfifo(p.c_str(), 0600); });
  special("a device", [](const fs::path& p) { fs::create_symlink("/dev/zero", p); });
  special("a sparse gigabyte", [](const fs::path& p) { write_file(p, ""), fs::resize_file(p, 1ULL << 30); });
  for (const std::string& name : std::initializer_list<std::string>{"", ".", "..", "/", "../memory/ddr4",
                                                                    "45nm.", "a\nb", std::string(5000, 'x')})
    group.cases.push_back(
        {"costs '" + name.substr(0, 30) + "'", charged(name), "--energy", {}, Expect::kRefused});
  return group;
}

}  // namespace quadrille::hostile
