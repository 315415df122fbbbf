#include "studies/explore/exploration.h"

#include <sys/resource.h>
#include <catch2/catch.hpp>

#include <csignal>
#include <filesystem>
#include <new>
#include <thread>

#include "models/base/error.h"
#include "pipeline/report/report.h"
#include "scenes/scene.h"
#include "studies/child_run.h"
#include "studies/explore/explore_table.h"
#include "studies/explore/point_run.h"
#include "tests/studies/explore/sweep_run.h"

namespace quadrille::studies::explore {
namespace {

using Catch::Contains;

struct Run : SweepRun {
  using SweepRun::SweepRun;
  [[nodiscard]] std::size_t draw() {
    std::size_t drawn = 0;
    setting.progress = [&](const ExploreProgress& p) { drawn = p.done; };
    Results results(results_file());
    Exploration(sweep, space, scenes, results, setting).run(plan.candidates);
    return drawn;
  }
  [[nodiscard]] PointRow row(std::size_t i) {
    Results results(results_file());
    return Exploration(sweep, space, scenes, results, setting).point(0, plan.candidates[i]).value();
  }
};

const std::string kFour = std::string(kTriangleScene) + "[vary]\ngpu.cores = [1, 2, 3, 4]\n";

}  // namespace

TEST_CASE("exploration: a point has the figures of a separate run, whatever the jobs") {
  const std::string text =
      std::string(kTriangleScene) + "[vary]\ngpu.cores = [1, 3]\ncore.warp_slots = [8, 32]\n";
  Run one(text, "builtin:materials"), three(text, "builtin:materials");
  three.setting.jobs = 3;
  CHECK(one.draw() == 4);
  CHECK(three.draw() == 4);
  for (std::size_t i = 0; i < 4; ++i) {
    const FigureMap together = figures_of(one.row(i).figures), apart = figures_of(three.row(i).figures);
    const std::string separate =
        output_of(run_in_child([&] {
                    pipeline::MachineConfig machine;
                    one.space.configure(one.plan.candidates[i].values, machine);
                    const auto frame = pipeline::render_exact(one.scenes[0].stream, machine);
                    return figure_lines(pipeline::report_json({frame.figures, machine, 16, 16}));
                  }),
                  "separate");
    CHECK(one.row(i).picture == three.row(i).picture);
    std::size_t compared = 0;
    for (const auto& [path, value] : figures_of(separate)) {
      if (path.starts_with("host.")) continue;
      CAPTURE(path);
      REQUIRE(together.at(path) == value);
      REQUIRE(apart.at(path) == value);
      ++compared;
    }
    CHECK(compared > 200);
  }
}

TEST_CASE("exploration: a point that crashes, hangs or takes all memory is a row, and the others go on") {
  Run run("seconds = 2\n" + kFour);
  run.setting.in_process = [](const SceneEntry&, const Candidate& candidate) {
    const std::string& cores = candidate.values[0];
    fprintf(stderr, "point of %s cores\n", cores.c_str());
    if (cores == "1") raise(SIGSEGV);
    if (cores == "2")
      while (true) std::this_thread::sleep_for(std::chrono::seconds(1));
    if (cores == "3") throw std::bad_alloc();
  };
  CHECK(run.draw() == 4);
  CHECK(run.row(0).status == "crashed");
  CHECK_THAT(run.row(0).reason, Contains("signal 11"));
  CHECK_THAT(run.row(0).log, Contains("point of 1 cores"));
  CHECK(run.row(1).status == "timed out");
  CHECK_THAT(run.row(1).reason, Contains("2 s"));
  CHECK(run.row(2).status == "refused");
  CHECK(run.row(2).reason == "out of memory");
  CHECK(run.row(3).done());
  CHECK(figures_of(run.row(3).figures).at("frame.cycles") > 0);

  // What failed is known; it is drawn again when that is asked for.
  run.setting.in_process = {};
  CHECK(run.draw() == 0);
  run.setting.retry_failed = true;
  CHECK(run.draw() == 3);
  for (std::size_t i = 0; i < 4; ++i) CHECK(run.row(i).done());
}

TEST_CASE("exploration: more points are added to what is known") {
  Run run(kFour);
  CHECK(run.draw() == 4);
  Run more(std::string(kTriangleScene) + "[vary]\ngpu.cores = [1, 2, 3, 4, 5]\n");
  std::filesystem::copy_file(run.folder.file("r.db"), more.folder.file("r.db"));
  CHECK(more.draw() == 1);
  // Another scene is another point.
  Run other(kFour, "builtin:cubes");
  std::filesystem::copy_file(run.folder.file("r.db"), other.folder.file("r.db"));
  CHECK(other.draw() == 4);
}

TEST_CASE("exploration: another version of the program is named before it mixes") {
  Run run(kFour);
  CHECK(run.draw() == 4);
  run.setting.version = "two";
  CHECK_THROWS_WITH(run.draw(), Contains("points of one") && Contains("this is two"));
  run.setting.mix_versions = true;
  CHECK(run.draw() == 0);
  CHECK(run.row(0).version == "one");
}

TEST_CASE("exploration: the disk is full for a while, and nothing is lost") {
  Run run(kFour);
  Results results(run.folder.file("full.db"));
  Exploration exploration(run.sweep, run.space, run.scenes, results, run.setting);
  rlimit before{}, small{};
  getrlimit(RLIMIT_FSIZE, &before);
  signal(SIGXFSZ, SIG_IGN);
  small = before;
  small.rlim_cur = 1;  // nothing can be written behind the first byte of a file
  std::size_t ended = 0;
  run.setting.progress = [&](const ExploreProgress&) {
    if (++ended == 3) setrlimit(RLIMIT_FSIZE, &before);
  };
  setrlimit(RLIMIT_FSIZE, &small);
  exploration.run(run.plan.candidates);
  CHECK(failed_points(run.plan, exploration) == 0);

  Results never(run.folder.file("never.db"));
  Exploration in_vain(run.sweep, run.space, run.scenes, never, run.setting);
  setrlimit(RLIMIT_FSIZE, &small);
  CHECK_THROWS_WITH(in_vain.run(run.plan.candidates), Contains("4 points were drawn in vain"));
  setrlimit(RLIMIT_FSIZE, &before);
}

TEST_CASE("results: one program at a time writes, and what is none is refused") {
  const SweepFolder folder;
  CHECK_THROWS_AS(Results(folder.write("no.db", std::string(2000, 'x'))), UserError);
  CHECK_THROWS_AS(Results("/nowhere/at/all.db"), UserError);
  Results first(folder.file("r.db"));
  const ChildRun second = run_in_child([&] {
    Results again(folder.file("r.db"));
    return std::string();
  });
  CHECK(second.end == ChildEnd::kRefused);
  CHECK_THAT(second.output, Contains("another program is writing"));
}

TEST_CASE("results: points of another file are taken over once, those that are done before others") {
  const SweepFolder folder;
  PointRow row;
  row.key = {"s", "m", 0};
  row.version = "one";
  row.status = "crashed";
  row.reason = "why";
  const std::vector<std::byte> png(10, std::byte{7});
  {
    Results part(folder.file("part.db"));
    row.status = "done";
    row.picture = "p";
    row.figures = "frame.cycles=12\nunits.l2_0.use=0.5\n";
    row.settings = {"gpu.cores=8"};
    part.save(row, png);
  }
  Results all(folder.file("all.db"));
  PointRow failed = row;
  failed.status = "crashed";
  all.save(failed, {});
  CHECK(all.take_over(folder.file("part.db")) == 1);
  CHECK(all.take_over(folder.file("part.db")) == 0);
  const PointRow got = all.load(row.key).value();
  CHECK(got.done());
  CHECK(figures_of(got.figures) == FigureMap{{"frame.cycles", 12}, {"units.l2_0.use", 0.5}});
  CHECK(got.settings == row.settings);
  CHECK(all.picture("p") == png);
  CHECK(all.versions() == std::vector<std::string>{"one"});
}

TEST_CASE("objectives: figures, sums over a kind, parameters and objectives above") {
  Run run(std::string(kTriangleScene) +
          "[vary]\ngpu.cores = [1, 2]\n"
          "[[objective]]\nname = \"work\"\nformula = \"all.core.instructions\"\n"
          "[[objective]]\nname = \"rate\"\nformula = \"work / frame.cycles / gpu.cores\"\ngoal = \"most\"\n"
          "[[objective]]\nname = \"second\"\nformula = \"units.core_1.counters.instructions\"\n");
  CHECK(run.draw() == 2);
  Results results(run.folder.file("r.db"));
  Exploration exploration(run.sweep, run.space, run.scenes, results, run.setting);
  exploration.check_formulas(run.plan.candidates[0]);
  for (std::size_t i = 0; i < 2; ++i) {
    const FigureMap figures = figures_of(exploration.point(0, run.plan.candidates[i])->figures);
    const std::vector<double> values = exploration.objectives(run.plan.candidates[i]).value();
    const double first = figures.at("units.core_0.counters.instructions");
    const double second = i == 0 ? 0 : figures.at("units.core_1.counters.instructions");
    CHECK(values[0] == first + second);
    CHECK(values[1] == Approx(values[0] / figures.at("frame.cycles") / static_cast<double>(i + 1)));
    CHECK(values[2] == second);
  }
  Run wrong(std::string(kTriangleScene) + "[[objective]]\nname = \"a\"\nformula = \"frame.cycels\"\n");
  Results none("");
  Exploration checked(wrong.sweep, wrong.space, wrong.scenes, none, wrong.setting);
  CHECK_THROWS_WITH(checked.check_formulas(wrong.plan.candidates[0]),
                    Contains("sweep.toml:6") && Contains("did you mean 'frame.cycles'"));
}

}  // namespace quadrille::studies::explore
