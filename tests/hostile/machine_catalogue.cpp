/// Machine files and settings, flags, shaders and outputs: what stands on the command line.
#include <sys/stat.h>

#include <fmt/format.h>

#include "tests/hostile/hostile_case.h"

namespace quadrille::hostile {
namespace {

std::vector<std::string> triangle(std::vector<std::string> more) {
  std::vector<std::string> arguments{"render", "builtin:triangle", "-q"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

const std::vector<std::string> kNumbers{"",
                                        " ",
                                        "-1",
                                        "0",
                                        "1e308",
                                        "-1e308",
                                        "1e999",
                                        "nan",
                                        "inf",
                                        "-inf",
                                        "99999999999999999999",
                                        "0x10",
                                        "1,5",
                                        "1.5.2",
                                        "one",
                                        "\xff\xfe",
                                        "1\n2",
                                        "--",
                                        "=",
                                        "\"1\"",
                                        "+1",
                                        "1e-320",
                                        "NaN(1)"};

}  // namespace

Group machine_cases() {
  Group group{"machine files, --set", "types, keys, numbers, encodings and files that are none", {}};
  const auto file = [&](const std::string& what, const std::string& text, Expect expect = Expect::kRefused) {
    group.cases.push_back({what, triangle({"--size", "16x16", "--machine", "m.toml", "--out", "x.png"}),
                           "m.toml", [=](const fs::path& folder) { write_file(folder / "m.toml", text); },
                           expect});
  };
  file("empty", "", Expect::kRendered);
  file("a comment", "# nothing\n", Expect::kRendered);
  for (const std::string value : {"\"2\"",
                                  "[2]",
                                  "{}",
                                  "{a=1}",
                                  "2.5",
                                  "-1",
                                  "0",
                                  "65",
                                  "9223372036854775807",
                                  "9223372036854775808",
                                  "1e308",
                                  "nan",
                                  "inf",
                                  "-inf",
                                  "true",
                                  "1979-05-27",
                                  "'''x'''",
                                  "0x7fffffff",
                                  "",
                                  "[[",
                                  "1 2",
                                  "\"\\u0000\"",
                                  "\"\xff\""})
    file("cores = " + value, "[gpu]\ncores = " + value + "\n",
         value == "{}" ? Expect::kEither : Expect::kRefused);
  file("clock_mhz = 1e308", "[gpu]\nclock_mhz = 1e308\n");
  file("clock_mhz = nan", "[gpu]\nclock_mhz = nan\n");
  file("an unknown key", "[gpu]\ncoors = 1\n");
  file("an unknown table", "[cpu]\ncores = 1\n");
  file("a key twice", "[gpu]\ncores = 1\ncores = 2\n");
  file("a table twice", "[gpu]\ncores = 1\n[gpu]\n");
  file("an array of tables", "[[gpu]]\ncores = 1\n");
  file("a table that is a number", "gpu = 1\n");
  file("a group that is a value", "link.core_to_rop = 3\n");
  file("a name that is a number", "name = 3\n");
  file("a name of two lines", "name = \"a\\nb\\u001b[2J\"\n", Expect::kRendered);
  file("zero bytes", std::string(1000, '\0'));
  file("bytes that are not UTF-8", "name = \"\xff\xfe\"\n");
  file("UTF-16", std::string("\xff\xfe[\0g\0", 6));
  file("100,000 brackets", "a = " + std::string(100000, '['));
  file("a dotted key of 300,000 parts", "a" + repeated(".a", 300000) + " = 1\n");
  file("a table of 300,000 parts", "[a" + repeated(".a", 300000) + "]\n");
  file("100,000 keys of 400 parts", repeated("a" + repeated(".a", 400) + " = 1\n", 1000));
  file("a megabyte of blanks", std::string(1 << 20, ' '));
  file("a string without an end", "name = \"\"\"" + repeated("x\n", 1000));
  file("caches smaller than their ways", "[texture]\ncache_lines = 1\ncache_ways = 64\n");
  const auto special = [&](const std::string& what, const std::function<void(const fs::path&)>& prepare) {
    group.cases.push_back({what, triangle({"--machine", "m.toml"}), "m.toml",
                           [=](const fs::path& f) { prepare(f / "m.toml"); }, Expect::kRefused});
  };
  special("a folder", [](const fs::path& p) { fs::create_directory(p); });
  special("a pipe", [](const fs::path& p) { mkfifo(p.c_str(), 0600); });
  special("a device", [](const fs::path& p) { fs::create_symlink("/dev/zero", p); });
  special("a sparse gigabyte", [](const fs::path& p) { write_file(p, ""), fs::resize_file(p, 1ULL << 30); });
  special("its own link", [](const fs::path& p) { fs::create_symlink("m.toml", p); });
  const std::string long_name(5000, 'x');
  for (const std::string& name : std::initializer_list<std::string>{"", ".", "..", "/", "default/../default",
                                                                    "../configs/default", long_name, "a\nb"})
    group.cases.push_back({"machine '" + name.substr(0, 30) + "'",
                           triangle({"--size", "16x16", "--machine", name}),
                           "",
                           {},
                           Expect::kEither});
  for (const std::string& value : kNumbers)
    for (const std::string key : {"gpu.cores", "gpu.clock_mhz"})
      group.cases.push_back({"--set " + key + "=" + value,
                             triangle({"--size", "16x16", "--set", key + "=" + value}),
                             "--set",
                             {},
                             Expect::kRefused});
  for (const std::string text : {"", "=", ".=1", "gpu=1", "gpu.=1", ".cores=1", "gpu..cores=1", "gpu.cores",
                                 "gpu.cores=1=2", "link.=1", "GPU.cores=1", "gpu.cores =1"})
    group.cases.push_back({"--set '" + text + "'", triangle({"--set", text}), "--set", {}, Expect::kRefused});
  group.cases.push_back({"--set of 100,000 letters",
                         triangle({"--set", std::string(100000, 'a')}),
                         "--set",
                         {},
                         Expect::kRefused});
  return group;
}

Group flag_cases() {
  Group group{"flags", "sizes, points, counts and words that are none", {}};
  for (const std::string flag : {"--size", "--camera", "--eye", "--at", "--max-cycles", "--fidelity",
                                 "--leave-out", "--driver", "--units"})
    for (const std::string& value : kNumbers) {
      if (flag == "--camera" && value == "0") continue;
      group.cases.push_back(
          {flag + " '" + value + "'", triangle({flag + "=" + value}), "", {}, Expect::kRefused});
    }
  for (const std::string size : {"1x1", "1x16384", "16384x1"})
    group.cases.push_back({"--size " + size,
                           triangle({"--size", size, "--fidelity", "functional"}),
                           "",
                           {},
                           Expect::kRendered});
  for (const std::string size :
       {"16385x1", "0x0", "-1x-1", "1x", "x1", "1x1x1", "4294967297x1", "1e3x1", "\xd9\xa1x1"})
    group.cases.push_back({"--size " + size, triangle({"--size", size}), "--size", {}, Expect::kRefused});
  for (const std::string point :
       {"1e39,0,0", "0,0", "0,0,0,0", ",,,", "nan,0,0", "0,0,inf", "0,0,0 ", "1e-50,0,0"})
    group.cases.push_back(
        {"--eye " + point, triangle({"--size", "16x16", "--eye", point}), "--eye", {}, Expect::kEither});
  for (const std::string point : {"1e30,0,0", "-3e38,3e38,0", "1e-30,0,0"})
    group.cases.push_back(
        {"--eye " + point, triangle({"--size", "16x16", "--eye=" + point}), "eye", {}, Expect::kEither});
  group.cases.push_back(
      {"a flag twice", triangle({"--size", "1x1", "--size", "2x2"}), "--size", {}, Expect::kEither});
  group.cases.push_back({"100,000 letters as a scene",
                         {"render", std::string(100000, 'a') + ".gltf"},
                         "aaa",
                         {},
                         Expect::kRefused});
  group.cases.push_back({"100,000 letters as a flag",
                         triangle({"--" + std::string(100000, 'a')}),
                         "aaa",
                         {},
                         Expect::kRefused});
  for (const std::string word : {"", "-", "--", "@file", "\n", "\xff", "-qq", "render"})
    group.cases.push_back({"'" + word + "' as a subcommand", {word, "x"}, "", {}, Expect::kRefused});
  for (const std::string scene : {"", " ", "builtin:", "builtin:\n", "builtin:../x", ".gltf", "/",
                                  "a.gltf/b.gltf", "a\nb.gltf", "/proc/self/mem", "/dev/null.gltf"})
    group.cases.push_back({"scene '" + scene + "'", {"render", scene}, "", {}, Expect::kRefused});
  return group;
}

Group shader_cases() {
  Group group{"shaders", "GLSL and SPIR-V that are damaged, of another stage, endless or without bounds", {}};
  const auto add = [&](const std::string& what, const std::string& text, Expect expect = Expect::kRefused,
                       const std::string& name = "s.frag", const std::string& flag = "--frag",
                       const std::string& fidelity = "functional") {
    group.cases.push_back(
        {what, triangle({"--size", "64x64", flag, name, "--fidelity", fidelity, "--out", "x.png"}), name,
         [=](const fs::path& folder) { write_file(folder / name, text); }, expect});
  };
  const std::string head = "#version 450\nlayout(location=0) out vec4 color;\n";
  const auto body = [&](const std::string& text) {
    return head + "void main() { vec4 s = gl_FragCoord; " + text + " color = s; }\n";
  };
  add("a plain one", body(""), Expect::kRendered);
  add("empty", "");
  add("zero bytes", std::string(1000, '\0'));
  add("binary",
      "\x7f"
      "ELF\x01\x02\xff\xfe");
  add("of the other stage", head + "void main() { gl_Position = vec4(0); }");
  add("a fragment shader as vertex shader", body(""), Expect::kRefused, "s.vert", "--vert");
  add("another version", "#version 9999\nvoid main() {}");
  add("an #include", "#version 450\n#include \"/etc/passwd\"\nvoid main() {}");
  add("#error of two lines", "#version 450\n#error a\\\nb\nvoid main() {}");
  add("recursion", head + "float f(float x) { return f(x - 1.0); }\nvoid main() { color = vec4(f(1.0)); }");
  add("mutual recursion", head +
                              "float g(float x);\nfloat f(float x) { return g(x); }\nfloat g(float x) { "
                              "return f(x); }\nvoid main() { color = vec4(f(1.0)); }");
  add("a varying that nobody writes",
      "#version 450\nlayout(location=9) in vec4 v; layout(location=0) out vec4 color;\nvoid main() { color = "
      "v; }");
  add("a uniform block that nobody binds",
      "#version 450\nlayout(set=3,binding=9) uniform U { vec4 v; }; layout(location=0) out vec4 color;\nvoid "
      "main() { color = v; }");
  add("an array of a billion", body("float a[1000000000]; a[int(s.x)] = 1.0; s.y = a[int(s.z)];"));
  add("an array of 100,000", body("float a[100000]; a[int(s.x)] = 1.0; s.y = a[int(s.z)];"));
  add("an array of minus one", body("float a[-1];"));
  add("an index beyond",
      body("float a[4] = float[4](1.0, 2.0, 3.0, 4.0); s.y = a[int(s.x * 1e9)] + a[int(-s.x)];"),
      Expect::kEither);
  for (const std::string fidelity : {"functional", "exact"}) {
    add("while (true), " + fidelity, body("while (true) { s += vec4(1); if (s.x < 0.0) break; }"),
        Expect::kRefused, "s.frag", "--frag", fidelity);
    add("for (;;) of a long body, " + fidelity,
        body("for (;;) {" + repeated("s = s * 1.0001 + sin(s.yzwx);", 400) + " if (s.x == 77.0) break; }"),
        Expect::kRefused, "s.frag", "--frag", fidelity);
    add("a thousand times a thousand times a thousand, " + fidelity,
        body("for (int i = 0; i < 1000; ++i) for (int j = 0; j < 1000; ++j) for (int k = 0; k < 1000; ++k) s "
             "= s.yzwx * 1.01 + float(i ^ j "
             "^ k);"),
        Expect::kRefused, "s.frag", "--frag", fidelity);
    add("endless in the vertex shader, " + fidelity,
        "#version 450\nlayout(location=0) in vec3 p;\nvoid main() { vec3 q = p; while (q.x < 5.0) q.y += "
        "1.0; gl_Position = vec4(q, 1); }",
        Expect::kRefused, "s.vert", "--vert", fidelity);
  }
  add("a textured loop without an end",
      "#version 450\nlayout(set=1,binding=1) uniform sampler2D t; layout(location=0) out vec4 color;\nvoid "
      "main() { vec4 s = vec4(0); "
      "while (s.x < 9.0) s += texture(t, s.xy) * 0.0; color = s; }");
  add("40 loops within each other", body([] {
        std::string nest, end;
        for (int k = 0; k < 40; ++k)
          nest += fmt::format("for (int i{0} = 0; i{0} < 2; ++i{0}) {{", k), end += "}";
        return nest + "s += 1.0;" + end;
      }()));
  add("2,000 brackets", body("s.x = " + repeated("(", 2000) + "1.0" + repeated(")", 2000) + ";"),
      Expect::kEither);
  add("100,000 brackets", body("s.x = " + repeated("(", 100000) + "1.0" + repeated(")", 100000) + ";"),
      Expect::kEither);
  add("100,000 blocks", body(repeated("{", 100000) + repeated("}", 100000)), Expect::kEither);
  add("100,000 signs", body("s.x = " + repeated("- ", 100000) + "1.0;"), Expect::kEither);
  add("100,000 statements", body(repeated("s = s.yzwx * 1.1;", 100000)), Expect::kEither);
  add("a doubling macro",
      "#version 450\n#define A x x x x x x x x x x\n#define B A A A A A A A A A A\n#define C B B B B B B B B "
      "B B\n#define D C C C C C C C "
      "C C C\n#define E D D D D D D D D D D\n#define F E E E E E E E E E E\n"
      "void main() { F F F F F F F F F F }");
  add("a macro of itself", "#version 450\n#define A A A\nvoid main() { A }");
  add("a megabyte of one name",
      head + "void main() { float " + std::string(1 << 20, 'n') + " = 1.0; color = vec4(0); }",
      Expect::kEither);
  add("text as SPIR-V", "no words of it..........", Expect::kRefused, "s.spv");
  add("SPIR-V of no words", "", Expect::kRefused, "s.spv");
  add("SPIR-V of a header",
      std::string("\x03\x02\x23\x07\x00\x00\x01\x00\x00\x00\x00\x00\xff\xff\xff\xff\x00\x00\x00\x00", 20),
      Expect::kRefused, "s.spv");
  add("SPIR-V of zeros behind a header",
      std::string("\x03\x02\x23\x07\x00\x00\x01\x00\x00\x00\x00\x00\x10\x00\x00\x00\x00\x00\x00\x00", 20) +
          std::string(4000, '\0'),
      Expect::kRefused, "s.spv");
  for (const std::string flag : {"--vert", "--frag"}) {
    group.cases.push_back({flag + " is missing", triangle({flag, "s.frag"}), "s.frag", {}, Expect::kRefused});
    group.cases.push_back({flag + " is a folder", triangle({flag, "s.frag"}), "s.frag",
                           [](const fs::path& f) { fs::create_directory(f / "s.frag"); }, Expect::kRefused});
    group.cases.push_back({flag + " is a pipe", triangle({flag, "s.frag"}), "s.frag",
                           [](const fs::path& f) { mkfifo((f / "s.frag").c_str(), 0600); },
                           Expect::kRefused});
    group.cases.push_back(
        {flag + " is a sparse gigabyte", triangle({flag, "s.frag"}), "s.frag",
         [](const fs::path& f) { write_file(f / "s.frag", ""), fs::resize_file(f / "s.frag", 1ULL << 30); },
         Expect::kRefused});
  }
  return group;
}

Group output_cases() {
  Group group{"outputs", "places that cannot be written", {}};
  for (const std::string flag : {"--out", "--depth", "--stats"}) {
    const std::string end = flag == "--stats" ? ".json" : ".png";
    const auto add = [&](const std::string& what, const std::string& path,
                         const std::function<void(const fs::path&)>& prepare = {}) {
      group.cases.push_back(
          {flag + " " + what, triangle({"--size", "16x16", flag, path}), flag, prepare, Expect::kRefused});
    };
    add("of nothing", "");
    add("is a folder", "f" + end, [=](const fs::path& f) { fs::create_directory(f / ("f" + end)); });
    add("below a file", "f/x" + end, [](const fs::path& f) { write_file(f / "f", ""); });
    add("below nothing", "none/x" + end);
    add("is a pipe", "f" + end, [=](const fs::path& f) { mkfifo((f / ("f" + end)).c_str(), 0600); });
    add("is a device", "f" + end,
        [=](const fs::path& f) { fs::create_symlink("/dev/full", f / ("f" + end)); });
    add("of 300 letters", std::string(300, 'x') + end);
    add("of 5,000 letters", std::string(5000, 'x') + end);
    add("below /proc", "/proc/x" + end);
    group.cases.back().culprit = "/proc/x";
    add("of another kind", "x.txt");
  }
  group.cases.push_back({"two outputs in one file",
                         triangle({"--size", "16x16", "--out", "x.png", "--depth", "./x.png"}),
                         "--depth",
                         {},
                         Expect::kRefused});
  group.cases.push_back({"an output that is its link", triangle({"--size", "16x16", "--out", "x.png"}),
                         "--out", [](const fs::path& f) { fs::create_symlink("x.png", f / "x.png"); },
                         Expect::kEither});
  group.cases.push_back({"a trace below nothing",
                         {"trace", "record", "builtin:triangle", "-o", "none/x.qtrace"},
                         "--out",
                         {},
                         Expect::kRefused});
  return group;
}

}  // namespace quadrille::hostile
