#include "pipeline/render.h"

#include <bit>
#include <chrono>
#include <functional>
#include <numeric>

#include "pipeline/driver/draw_culling.h"
#include "pipeline/driver/host_cost.h"
#include "pipeline/machine/wave_file.h"
#include "pipeline/prepared_frame.h"
#include "pipeline/report/detail_log.h"
#include "pipeline/report/flow_log.h"
#include "pipeline/watched_render.h"

namespace quadrille::pipeline {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

FrameImage read_image(const DeviceFrame& frame) {
  FrameImage image;
  if (frame.frame.passes.empty()) return image;
  const hw::PassState& pass = frame.frame.passes.back();
  const hw::AttachmentState& shown = pass.picture();
  frame.memory.check_readable(shown.surface.base, shown.surface.bytes(), models::DeviceMemory::kClean);
  image.width = pass.width;
  image.height = pass.height;
  const std::vector<models::PixelCode> codes = models::detile_codes(frame.memory, shown.surface);
  image.color.reserve(codes.size());
  for (const models::PixelCode& code : codes) image.color.push_back(models::to_rgba8(shown.format, code));
  if (models::is_float_format(shown.format)) {
    image.linear.reserve(codes.size());
    for (const models::PixelCode& code : codes)
      image.linear.push_back(models::decode_color(shown.format, code));
  }
  if (pass.has_depth) {
    const std::vector<models::PixelCode> depths = models::detile_codes(frame.memory, pass.depth.surface);
    image.depth.reserve(depths.size());
    for (const models::PixelCode& code : depths)
      image.depth.push_back(models::decode_depth(pass.depth.format, code));
  } else if (frame.shown_has_depth) {
    image.depth.assign(image.color.size(), pass.clear_depth);  // nothing tested or wrote it
  }
  return image;
}

std::vector<BufferContents> read_buffers(const DeviceFrame& frame) {
  std::vector<BufferContents> buffers;
  for (const WrittenBuffer& written : frame.written_buffers) {
    const std::span<const std::byte> data = frame.memory.read(written.address, written.bytes);
    buffers.push_back({written.buffer, {data.begin(), data.end()}});
  }
  return buffers;
}

/// Times a run on a frame, without what bringing its textures took.
class RunTimer {
 public:
  explicit RunTimer(const TextureFills& fills) : fills_(fills) {}
  void stop(HostFigures& host) const {
    host.unpack_s = fills_.seconds();
    host.simulate_s = seconds_since(start_) - (fills_.seconds() - unpacked_);
    host.simulate_cpu_s = cpu_seconds() - cpu_ - (fills_.cpu_seconds() - unpacked_cpu_);
  }

 private:
  const TextureFills& fills_;
  Clock::time_point start_ = Clock::now();
  double cpu_ = cpu_seconds(), unpacked_ = fills_.seconds(), unpacked_cpu_ = fills_.cpu_seconds();
};

void note_pending(const DeviceFrame& frame, std::vector<LeftOut>& left_out) {
  const auto [textures, texels] = frame.fills.pending();
  if (textures == 0) return;
  left_out.push_back({"texels", "no fragment or vertex of the frame samples the textures",
                      fmt::format("{} textures, {} texels stay where they are", textures, texels)});
}

void finish_host(HostFigures& host, const FrameFigures& frame) {
  host.peak_rss_mib = peak_rss_mib();
  if (host.simulate_s <= 0) return;
  host.fragments_per_s = static_cast<double>(frame.fragments_shaded) / host.simulate_s;
  host.cycles_per_s = static_cast<double>(frame.cycles) / host.simulate_s;
}

}  // namespace

RenderedFrame render_functional_frame(const traces::CommandStream& stream, const models::Precision& precision,
                                      const PieceObserver& observer) {
  RenderedFrame out;
  const auto start = Clock::now();
  DeviceFrame frame(std::uint64_t{4} << 30);
  build_frame(stream, precision, frame);
  HostFigures& host = out.figures.host;
  host.build_s = seconds_since(start) - frame.fills.seconds();
  const RunTimer timer(frame.fills);
  const FunctionalCounts counts = render_functional(frame.frame, frame.memory, observer);
  timer.stop(host);
  out.figures.fidelity = "functional";
  out.figures.scene = stream.name;
  out.figures.left_out = frame.left_out;
  out.figures.queries = query_figures(frame.queries, counts.samples_passed);
  out.figures.order_dependent = frame.order_dependent();
  note_pending(frame, out.figures.left_out);
  FrameFigures& f = out.figures.frame;
  f.draws = frame.frame.draws.size();
  f.triangles = counts.triangles;
  f.vertices = counts.vertices;
  f.fragments_covered = counts.fragments_covered;
  f.fragments_shaded = counts.fragments_shaded;
  f.helper_lanes = counts.helper_lanes;
  f.fragments_written = counts.fragments_written;
  f.fates = counts.fates;
  finish_host(host, f);
  out.image = read_image(frame);
  out.buffers = read_buffers(frame);
  return out;
}

std::vector<Check> checks_of(const KeptCounters& kept) {
  const auto sum = [](const std::vector<std::uint64_t>& counts) {
    return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
  };
  std::vector<Check> checks;
  if (!kept.by_draw.asked.empty()) {
    std::uint64_t draws = sum(kept.by_draw.outside);
    for (const std::vector<std::uint64_t>& draw : kept.by_draw.draws) draws += sum(draw);
    checks.push_back({"counters behind the energy, of draws and of none = of the units",
                      "draws + outside_draws", "units", draws, kept.by_draw.total});
  }
  for (const CounterBySquare& c : kept.by_square)
    checks.push_back({fmt::format("{} of tiles and of none = of the frame", c.key),
                      fmt::format("tiles.{} + outside_tiles", c.key),
                      fmt::format("{}.{}", c.asked.kind, c.asked.counter), sum(c.squares) + c.outside,
                      c.total});
  return checks;
}

namespace {

/// Who looks at a machine before and after its run.
struct RunWatch {
  std::function<void(const Machine&)> begin;
  std::function<void()> end;
};

void add_path(CriticalPath path, const Machine& machine, Figures& figures) {
  hw::Tick parts = 0;
  for (const PathShare& part : path.parts) parts += part.ticks;
  const auto femtoseconds = [](hw::Tick ticks) { return static_cast<std::uint64_t>(ticks); };
  figures.checks.push_back({"parts of the critical path = the frame, in femtoseconds", "critical_path.parts",
                            "frame.cycles", femtoseconds(parts), femtoseconds(machine.end())});
  figures.path = std::move(path);
}

std::uint64_t memory_bytes_of(const MachineConfig& config) {
  return static_cast<std::uint64_t>(config.gpu.memory_mib.value()) << 20;
}

/// Simulates a frame that is built, which took `build_s`.
RenderedFrame simulate_built(DeviceFrame& frame, const std::string& scene, const MachineConfig& config,
                             const MachineOptions& options, const hw::RunLimits& limits, DetailOptions detail,
                             KeptCounters* kept, double build_s, const RunWatch& watch = {}) {
  RenderedFrame out;
  const auto start = Clock::now();
  if (config.command_processor.cull_draws) find_draws_outside(frame.frame, frame.memory);
  Machine machine(config, frame, options);
  std::optional<DetailLog> log;
  if (detail.any() || !frame.queries.empty()) log.emplace(machine, frame, detail, kept);
  std::optional<FlowLog> flow;
  if (detail.timeline) flow.emplace(machine);
  std::optional<CriticalPathLog> charges;
  if (detail.path) charges.emplace(machine);
  if (detail.misses) keep_miss_kinds(machine);
  if (detail.textures) keep_texture_use(machine, frame);
  build_s += seconds_since(start);
  const RunTimer timer(frame.fills);
  if (watch.begin) watch.begin(machine);
  machine.run(limits);
  if (watch.end) watch.end();
  HostFigures host;
  timer.stop(host);
  host.build_s = build_s;
  out.figures = collect_figures(machine, frame, log ? std::optional(log->collect()) : std::nullopt);
  if (kept != nullptr && log)
    for (Check& check : checks_of(*kept)) out.figures.checks.push_back(std::move(check));
  if (flow) flow->collect(out.figures);
  if (charges) add_path(charges->follow(detail.draws), machine, out.figures);
  if (detail.misses) collect_miss_kinds(machine, out.figures);
  if (detail.textures) collect_texture_use(machine, frame, out.figures);
  out.figures.report_timeline = detail.timeline;
  host.actions = out.figures.host.actions;
  out.figures.host = host;
  note_pending(frame, out.figures.left_out);
  out.figures.order_dependent = frame.order_dependent();
  out.figures.scene = scene;
  out.figures.faster = options.faster;
  if (options.window > 0) {
    out.figures.fidelity = "approximate";
    out.figures.window_cycles = machine.clock().edges_before(options.window);
  }
  finish_host(out.figures.host, out.figures.frame);
  out.image = read_image(frame);
  out.buffers = read_buffers(frame);
  return out;
}

RenderedFrame simulate(const traces::CommandStream& stream, const MachineConfig& config,
                       const MachineOptions& options, const hw::RunLimits& limits, DetailOptions detail,
                       KeptCounters* kept, const RunWatch& watch = {}) {
  const auto start = Clock::now();
  DeviceFrame frame(memory_bytes_of(config));
  build_frame(stream, config.precision(), frame, options.leave_out, config.frame_target());
  const double build_s = seconds_since(start) - frame.fills.seconds();
  return simulate_built(frame, stream.name, config, options, limits, detail, kept, build_s, watch);
}

}  // namespace

RenderedFrame render_exact(const traces::CommandStream& stream, const MachineConfig& config,
                           const MachineOptions& options, const hw::RunLimits& limits, DetailOptions detail) {
  return simulate(stream, config, options, limits, detail, nullptr);
}

RenderedFrame render_exact_watched(const traces::CommandStream& stream, const MachineConfig& config,
                                   const MachineOptions& options, const hw::RunLimits& limits,
                                   const DetailOptions& detail, KeptCounters& kept) {
  return simulate(stream, config, options, limits, detail, &kept);
}

RenderedFrame render_exact_with_waves(const traces::CommandStream& stream, const MachineConfig& config,
                                      MachineOptions options, const hw::RunLimits& limits,
                                      const DetailOptions& detail, KeptCounters& kept,
                                      const std::string& vcd) {
  hw::NativeDriver driver("native_driver");
  options.external_driver = &driver;
  std::optional<WaveFile> waves;
  const RunWatch watch{[&](const Machine& machine) { waves.emplace(machine, driver, vcd); },
                       [&] { waves->finish(); }};
  return simulate(stream, config, options, limits, detail, &kept, watch);
}

PreparedFrame::PreparedFrame(const traces::CommandStream& stream, const MachineConfig& config)
    : stream_(stream), needs_(needs(config)), frame_(std::make_unique<DeviceFrame>(memory_bytes_of(config))) {
  build_frame(stream, config.precision(), *frame_, true, config.frame_target());
  for (const hw::DrawState& draw : frame_->frame.draws)
    for (const hw::ProgramState* program : {&draw.vertex, &draw.fragment})
      for (const hw::TextureState& texture : program->textures)
        if (texture.fill != nullptr) texture.fill->need();
}

PreparedFrame::~PreparedFrame() = default;

std::string PreparedFrame::needs(const MachineConfig& config) {
  const models::Precision p = config.precision();
  const ShaderTarget t = config.shader_target();
  std::string text =
      fmt::format("{} {} {} {} {} {} {} {} {}", config.gpu.memory_mib.value(), p.subpixel_bits,
                  p.subtexel_bits, p.lod_bits, p.linear_log2, static_cast<int>(p.anisotropic_footprint),
                  t.warp_slots, t.register_rows, static_cast<int>(config.texture.layout.value()));
  for (const models::IssueTiming::Class& c : t.timing.classes)
    text += fmt::format(" {}/{}", c.issue, c.latency);
  return text;
}

RenderedFrame PreparedFrame::render(const MachineConfig& config, const MachineOptions& options,
                                    const hw::RunLimits& limits) {
  QUADRILLE_CHECK(needs(config) == needs_, "a frame for {}, a machine of {}", needs_, needs(config));
  return simulate_built(*frame_, stream_.name, config, options, limits, {}, nullptr, 0);
}

}  // namespace quadrille::pipeline
