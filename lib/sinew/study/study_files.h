// SPDX-License-Identifier: GPL-3.0-or-later
// The files of a study: study.csv for spreadsheets, study.json for scripts, report.html for people.
//
//     write_study(study_runs(folders, {}), "out/study");
#pragma once

#include <filesystem>
#include <string>

#include <sinew/study/study.h>

namespace sinew {

/// A row per result: name, kind, unit, its value in each run (a column of that name), limit, error,
/// order. Numbers read back as the same bits; "nan" where there is none.
std::string study_csv(const Study& study);

/// - schema_version: 1; frames (that all runs have), by_radius, remarks
/// - runs: name, radius, particles, seconds
/// - settings: section, name, values (by run)
/// - results: name, kind, unit, values (by run), limit, error, order
std::string study_json(const Study& study);

/// report.html: the runs, what differs between their scenes, their results with limits, and each
/// metric of all runs over time. The whole page, UTF-8.
std::string study_html(const Study& study, const std::string& title);

/// Adds the limit of a curve over the radius, with its error, at radius 0 and in the note.
void add_limit(LawCurve& curve, const ContinuumLimit& limit);

/// Writes the three files into `out`, which is created and titles the page. Throws not written.
void write_study(const Study& study, const std::filesystem::path& out);

}  // namespace sinew
