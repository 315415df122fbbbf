/// The timeline in the two formats of traces that Perfetto reads.
#include "pipeline/report/timeline.h"

#include "pipeline/report/perfetto.pb.h"

#include <nlohmann/json.hpp>

#include <cmath>

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
  std::uint64_t counter(std::string_view name, std::uint64_t parent) {
    perfetto::TrackDescriptor& track = new_track(name, parent);
    track.mutable_counter()->set_unit_name("%");
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
      number("draw", span.draw);
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
      Json args = {{"draw", span.draw}, {"pass", draw.pass.index()}};
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
  for (const UnitCurves& unit : line.units) {
    const std::uint64_t parent = writer.track(unit.unit, process);
    for (const ResourceCurve& curve : unit.resources) {
      const std::uint64_t track = writer.counter(counter_name(curve), parent);
      const auto value = [&](double cycle, double share) {
        writer.event(cycle, perfetto::TrackEvent::TYPE_COUNTER, track).set_double_counter_value(100 * share);
      };
      for (std::size_t s = 0; s < line.slices; ++s) value(line.begin_of(s), curve.share[s]);
      value(static_cast<double>(line.cycles), 0);
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
  for (const UnitCurves& unit : line.units) {
    for (const ResourceCurve& curve : unit.resources) {
      const std::string name = fmt::format("{} {}", unit.unit, counter_name(curve));
      const auto value = [&](double cycle, double share) {
        events.push_back({{"ph", "C"},
                          {"name", name},
                          {"pid", kProcess},
                          {"ts", microseconds(cycle)},
                          {"args", {{"%", 100 * share}}}});
      };
      for (std::size_t s = 0; s < line.slices; ++s) value(line.begin_of(s), curve.share[s]);
      value(static_cast<double>(line.cycles), 0);
    }
  }
  const Json document = {{"displayTimeUnit", "ns"}, {"traceEvents", std::move(events)}};
  return document.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace quadrille::pipeline
