/// What this process has cost its host so far.
#pragma once

namespace quadrille::pipeline {

/// Processor time of all its threads, in seconds.
[[nodiscard]] double cpu_seconds();
/// The most memory that it held at a time, in MiB.
[[nodiscard]] double peak_rss_mib();

}  // namespace quadrille::pipeline
