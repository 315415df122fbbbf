/// The timeline in the two formats of traces that Perfetto reads.
#include "pipeline/report/timeline.h"

#include "pipeline/report/perfetto.pb.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <utility>

namespace quadrille::pipeline {

namespace {

constexpr int kProcess = 1;

std::string title_of(const ReportSubject& subject) {
  return fmt::format("{}, {}x{}, machine {} (1 ns is 1 cycle)", subject.figures.scene, subject.width,
                     subject.height, subject.machine.title());
}

std::string counter_name(const ResourceCurve& curve) {
  switch (curve.kind) {
    case hw::Resource::Kind::kRate: return fmt::format("{}: used", curve.resource);
    case hw::Resource::Kind::kLoss: return fmt::format("{}: lost", curve.resource);
    case hw::Resource::Kind::kPlaces: return fmt::format("{}: all taken", curve.resource);
  }
  return {};
}

/// A counter of a track, by slice.
struct CounterCurve {
  std::string name;
  std::string_view unit;
  std::vector<double> value;
};
struct CounterTrack {
  std::string_view name;
  std::vector<CounterCurve> counters;
};

/// Units with their resources in percent, then what moved.
std::vector<CounterTrack> counter_tracks(const Timeline& line) {
  std::vector<CounterTrack> tracks;
  tracks.reserve(line.units.size() + line.flow.size());
  for (const UnitCurves& unit : line.units) {
    CounterTrack track{unit.unit, {}};
    track.counters.reserve(unit.resources.size());
    for (const ResourceCurve& curve : unit.resources) {
      CounterCurve counter{counter_name(curve), "%", curve.share};
      for (double& value : counter.value) value *= 100;
      track.counters.push_back(std::move(counter));
    }
    tracks.push_back(std::move(track));
  }
  for (const FlowCurves& flow : line.flow) {
    CounterTrack track{flow.what, {}};
    track.counters.reserve(flow.curves.size());
    for (const FlowCurve& curve : flow.curves) track.counters.push_back({curve.name, flow.unit, curve.value});
    tracks.push_back(std::move(track));
  }
  return tracks;
}

/// Calls `visit(cycle, value)` at the begin of every slice, and with 0 at the frame's end.
template <class Visit>
void visit_values(const Timeline& line, const CounterCurve& counter, const Visit& visit) {
  for (std::size_t s = 0; s < line.slices; ++s) visit(line.begin_of(s), counter.value[s]);
  visit(static_cast<double>(line.cycles), 0.0);
}

/// What a draw's slice tells beside its label: counts that are not zero, by "group.name".
template <class Visit>
void visit_counts(const DrawFigures& draw, const Visit& visit) {
  for (std::size_t i = 0; i < kReportedDrawCounts; ++i) {
    if (draw.counts[i] == 0) continue;
    visit(fmt::format("{}.{}", draw_counts()[i].group, draw_counts()[i].key), draw.counts[i]);
  }
}

/// Writes packets of one sequence, with tracks that are numbered as they come.
class PacketWriter {
 public:
  std::uint64_t process(const std::string& title) {
    perfetto::TrackDescriptor& track = new_track("", 0);
    track.mutable_process()->set_pid(kProcess);
    track.mutable_process()->set_process_name(title);
    return track.uuid();
  }
  std::uint64_t track(std::string_view name, std::uint64_t parent) { return new_track(name, parent).uuid(); }
  std::uint64_t counter(std::string_view name, std::string_view unit, std::uint64_t parent) {
    perfetto::TrackDescriptor& track = new_track(name, parent);
    track.mutable_counter()->set_unit_name(std::string(unit));
    return track.uuid();
  }
  perfetto::TrackEvent& event(double cycle, perfetto::TrackEvent::Type type, std::uint64_t track) {
    perfetto::TracePacket& p = packet();
    p.set_timestamp(static_cast<std::uint64_t>(std::llround(cycle)));
    p.mutable_track_event()->set_type(type);
    p.mutable_track_event()->set_track_uuid(track);
    return *p.mutable_track_event();
  }
  [[nodiscard]] std::string bytes() const { return trace_.SerializeAsString(); }

 private:
  perfetto::TracePacket& packet() {
    perfetto::TracePacket& p = *trace_.add_packet();
    p.set_trusted_packet_sequence_id(1);
    return p;
  }
  perfetto::TrackDescriptor& new_track(std::string_view name, std::uint64_t parent) {
    perfetto::TrackDescriptor& track = *packet().mutable_track_descriptor();
    track.set_uuid(++tracks_);
    if (parent != 0) track.set_parent_uuid(parent);
    if (!name.empty()) track.set_name(std::string(name));
    return track;
  }
  perfetto::Trace trace_;
  std::uint64_t tracks_ = 0;
};

void write_draws(PacketWriter& writer, const Timeline& line, const std::vector<DrawFigures>& draws,
                 std::uint64_t process) {
  for (std::size_t row = 0; row < line.draw_rows.size(); ++row) {
    const std::uint64_t track = writer.track(row == 0 ? "draws" : fmt::format("draws {}", row + 1), process);
    for (const DrawSpan& span : line.draw_rows[row]) {
      const DrawFigures& draw = draws[span.draw];
      perfetto::TrackEvent& begin =
          writer.event(static_cast<double>(span.begin), perfetto::TrackEvent::TYPE_SLICE_BEGIN, track);
      begin.set_name(draw.label.empty() ? fmt::format("draw {}", span.draw) : draw.label);
      const auto number = [&](const std::string& name, std::uint64_t value) {
        perfetto::DebugAnnotation& note = *begin.add_debug_annotations();
        note.set_name(name);
        note.set_uint_value(value);
      };
      const auto text = [&](const std::string& name, const std::string& value) {
        perfetto::DebugAnnotation& note = *begin.add_debug_annotations();
        note.set_name(name);
        note.set_string_value(value);
      };
      number("draw", span.draw);
      text("vertex shader", draw.vertex_shader);
      text("fragment shader", draw.fragment_shader);
      number("pass", draw.pass.index());
      visit_counts(draw, number);
      (void)writer.event(static_cast<double>(span.end), perfetto::TrackEvent::TYPE_SLICE_END, track);
    }
  }
}

using Json = nlohmann::ordered_json;

/// Chrome's viewer counts microseconds.
double microseconds(double cycle) { return cycle / 1000; }

void add_draws(Json& events, const Timeline& line, const std::vector<DrawFigures>& draws) {
  for (std::size_t row = 0; row < line.draw_rows.size(); ++row) {
    const std::size_t thread = row + 1;
    events.push_back({{"ph", "M"},
                      {"name", "thread_name"},
                      {"pid", kProcess},
                      {"tid", thread},
                      {"args", {{"name", row == 0 ? "draws" : fmt::format("draws {}", row + 1)}}}});
    for (const DrawSpan& span : line.draw_rows[row]) {
      const DrawFigures& draw = draws[span.draw];
      Json args = {{"draw", span.draw},
                   {"vertex shader", draw.vertex_shader},
                   {"fragment shader", draw.fragment_shader},
                   {"pass", draw.pass.index()}};
      visit_counts(draw, [&](const std::string& name, std::uint64_t value) { args[name] = value; });
      events.push_back({{"ph", "X"},
                        {"name", draw.label.empty() ? fmt::format("draw {}", span.draw) : draw.label},
                        {"pid", kProcess},
                        {"tid", thread},
                        {"ts", microseconds(static_cast<double>(span.begin))},
                        {"dur", microseconds(static_cast<double>(span.end - span.begin))},
                        {"args", std::move(args)}});
    }
  }
}

}  // namespace

std::string timeline_protobuf(const ReportSubject& subject) {
  const Timeline line = timeline_of(subject.figures);
  PacketWriter writer;
  const std::uint64_t process = writer.process(title_of(subject));
  if (subject.figures.detail) write_draws(writer, line, subject.figures.detail->draws, process);
  for (const CounterTrack& track : counter_tracks(line)) {
    const std::uint64_t parent = writer.track(track.name, process);
    for (const CounterCurve& counter : track.counters) {
      const std::uint64_t id = writer.counter(counter.name, counter.unit, parent);
      visit_values(line, counter, [&](double cycle, double value) {
        writer.event(cycle, perfetto::TrackEvent::TYPE_COUNTER, id).set_double_counter_value(value);
      });
    }
  }
  return writer.bytes();
}

std::string timeline_trace_json(const ReportSubject& subject) {
  const Timeline line = timeline_of(subject.figures);
  Json events = Json::array();
  events.push_back(
      {{"ph", "M"}, {"name", "process_name"}, {"pid", kProcess}, {"args", {{"name", title_of(subject)}}}});
  if (subject.figures.detail) add_draws(events, line, subject.figures.detail->draws);
  for (const CounterTrack& track : counter_tracks(line)) {
    for (const CounterCurve& counter : track.counters) {
      const std::string name = fmt::format("{} {}", track.name, counter.name);
      visit_values(line, counter, [&](double cycle, double value) {
        events.push_back({{"ph", "C"},
                          {"name", name},
                          {"pid", kProcess},
                          {"ts", microseconds(cycle)},
                          {"args", {{std::string(counter.unit), value}}}});
      });
    }
  }
  const Json document = {{"displayTimeUnit", "ns"}, {"traceEvents", std::move(events)}};
  return document.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace quadrille::pipeline
