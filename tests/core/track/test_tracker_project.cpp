#include "core/track/tracker_project.h"

#include <cmath>
#include <numbers>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/track/bare_track.h"
#include "core/track/track_data.h"
#include "core/track/tracker_xml.h"
#include "tests/catch.h"
#include "tests/core/made_project.h"
#include "tests/core/notes.h"
#include "tests/core/real_data.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using Catch::Matchers::Contains;
using tests::made_mass;
using tests::MadeProject;

namespace {

/// x = 100 + 2 i + i² px along the image's x, at rest across it.
const tests::MadeMass kAlong =
    made_mass("mass A", 12, [](double i) { return std::pair(100.0 + 2.0 * i + i * i, 80.0); });
/// The same downwards.
const tests::MadeMass kDown = made_mass("ball", 12, [](double i) { return std::pair(50.0, 100.0 + 2.0 * i + i * i); });

double travelled(std::size_t i) {
  const auto n = static_cast<double>(i);
  return 2.0 * n + n * n;
}

struct Folder {
  tests::TempDir temp;
  core::TrackData read(const MadeProject& project, std::optional<core::Downhill> downhill = {},
                       const std::string& mass = "") const {
    return core::read_track(tests::write_text(temp / "made.trk", project.text()), downhill, mass);
  }
  std::string refusal(const MadeProject& project, const std::string& mass = "") const {
    try {
      read(project, {}, mass);
    } catch (const base::InputError& error) {
      return error.what();
    }
    return "";
  }
};

/// The point mass and the coordinate that are read as x.
core::PointMassTaken taken_of(const core::TrackData& track) {
  const auto* const taken = tests::note_of<core::PointMassTaken>(track.notes);
  REQUIRE(taken != nullptr);
  return *taken;
}

}  // namespace

TEST_CASE("a project's positions are in its scale, from its origin, at its times") {
  const Folder folder;
  MadeProject project{{kAlong}};
  project.axes = {{0, 60.0, 200.0, 0.0, 250.0}};
  project.frame_ms = 4.0;
  const core::TrackData track = folder.read(project);
  REQUIRE(track.x_m.size() == 12);
  for (std::size_t i = 0; i < 12; ++i) {
    CHECK(std::abs(track.x_m[i] - (40.0 + travelled(i)) / 250.0) < 1e-12);
    CHECK(std::abs(track.t_s[i] - 0.004 * static_cast<double>(i)) < 1e-12);
  }
  CHECK(track.frame_rate_hz == Approx(250.0));
  CHECK(taken_of(track).mass == "mass A");
  CHECK_FALSE(taken_of(track).along_y);
  CHECK(tests::note_of<core::NoLengthUnit>(track.notes) == nullptr);
  project.unit = "cm";
  CHECK(std::abs(folder.read(project).x_m[3] - 0.01 * (40.0 + travelled(3)) / 250.0) < 1e-12);
  project.unit = "";
  CHECK(tests::note_of<core::NoLengthUnit>(folder.read(project).notes) != nullptr);
  CHECK(std::abs(folder.read(project, core::Downhill::minus_x).x_m[3] + (40.0 + travelled(3)) / 250.0) < 1e-12);
}

TEST_CASE("what falls in the image is positive downwards along Y, unless downhill says otherwise") {
  const Folder folder;
  MadeProject project{{kDown}};
  const core::TrackData down = folder.read(project);
  CHECK(std::abs(down.x_m[5] - down.x_m[0] - travelled(5) / 100.0) < 1e-12);
  CHECK(taken_of(down).towards == "-Y");
  CHECK(taken_of(down).along_y);
  CHECK_FALSE(taken_of(down).as_stated);
  const core::TrackData up = folder.read(project, core::Downhill::plus_y);
  CHECK(std::abs(up.x_m[5] - up.x_m[0] + travelled(5) / 100.0) < 1e-12);
  CHECK(taken_of(up).as_stated);
  // Axes turned by half a turn: +Y is down.
  project.axes = {{0, 0.0, 0.0, 180.0, 100.0}};
  const core::TrackData turned = folder.read(project);
  CHECK(std::abs(turned.x_m[5] - turned.x_m[0] - travelled(5) / 100.0) < 1e-12);
  CHECK(taken_of(turned).towards == "+Y");
}

TEST_CASE("axes along an inclined track give the whole distance, level ones less by the cosine, with a note") {
  const Folder folder;
  const double angle = 20.0 * std::numbers::pi / 180.0;  // rising to the right: up in the image is against y
  MadeProject project{{made_mass("cart", 12, [&](double i) {
    const double along = 2.0 * i + i * i;
    return std::pair(100.0 + along * std::cos(angle), 300.0 - along * std::sin(angle));
  })}};
  project.axes = {{0, 100.0, 300.0, 20.0, 100.0}};
  const core::TrackData along = folder.read(project);
  for (std::size_t i = 0; i < 12; ++i) CHECK(std::abs(along.x_m[i] - travelled(i) / 100.0) < 1e-12);
  CHECK(tests::note_of<core::MassMovesAslant>(along.notes) == nullptr);
  project.axes = {{0, 100.0, 300.0, 0.0, 100.0}};
  const core::TrackData level = folder.read(project);
  CHECK(std::abs(level.x_m[9] - std::cos(angle) * travelled(9) / 100.0) < 1e-12);
  const auto* const aslant = tests::note_of<core::MassMovesAslant>(level.notes);
  REQUIRE(aslant != nullptr);
  CHECK(aslant->off_deg == Approx(20.0).epsilon(1e-9));
  CHECK(aslant->short_by == Approx(1.0 - std::cos(angle)).epsilon(1e-9));
  CHECK_FALSE(aslant->along_y);
}

TEST_CASE("axes that change from frame to frame hold from their key frame on, where they are not fixed") {
  const Folder folder;
  MadeProject project{{kAlong}};
  // The camera is pushed by 30 px between frames 4 and 5; whoever tracked it moved the origin along, and saw the scale.
  project.masses[0].points.clear();
  for (long i = 0; i < 12; ++i) {
    const double seen = i < 5 ? 100.0 + 1.0 * travelled(static_cast<std::size_t>(i))
                              : 130.0 + 2.0 * travelled(static_cast<std::size_t>(i));
    project.masses[0].points.push_back({i, {seen, 80.0}});
  }
  project.axes = {{0, 100.0, 0.0, 0.0, 100.0}, {5, 130.0, 0.0, 0.0, 200.0}};
  project.fixed = false;
  const core::TrackData track = folder.read(project);
  for (std::size_t i = 0; i < 12; ++i) CHECK(std::abs(track.x_m[i] - travelled(i) / 100.0) < 1e-12);
  // Fixed, the last values that are stated count in all frames, as Tracker reads them.
  project.fixed = true;
  CHECK(std::abs(folder.read(project).x_m[0] - (100.0 - 130.0) / 200.0) < 1e-12);
}

TEST_CASE("positions count in the steps of the clip, at starttime and step by step") {
  const Folder folder;
  MadeProject project{{made_mass("mass A", 40, [](double i) { return std::pair(10.0 * i, 0.0); })}};
  project.clip = tests::property_text("startframe", "int", "4") + tests::property_text("stepsize", "int", "3") +
                 tests::property_text("stepcount", "int", "9") + tests::number_text("starttime", 500.0);
  const core::TrackData track = folder.read(project);
  REQUIRE(track.x_m.size() == 9);  // frames 4, 7, ... 28
  CHECK(std::abs(track.t_s[0] - 0.5) < 1e-12);
  CHECK(std::abs(track.t_s[2] - 0.56) < 1e-12);
  CHECK(std::abs(track.x_m[2] - 1.0) < 1e-12);
  const auto* const outside = tests::note_of<core::PositionsOutsideClip>(track.notes);
  REQUIRE(outside != nullptr);
  CHECK(outside->positions == 31);
}

TEST_CASE("steps without a mark are frames without a sighting, and what Tracker filled in is left out") {
  const Folder folder;
  MadeProject project{{kAlong}};
  project.masses[0].points.erase(project.masses[0].points.begin() + 5);
  const core::TrackData track = folder.read(project);
  CHECK(track.x_m.size() == 11);
  CHECK(track.frame_t_s.size() == 12);
  CHECK(track.frame[5] == 6);
  // Frames 4 and 5 on the straight line from frame 3 to frame 6.
  MadeProject filled{{kAlong}};
  auto& points = filled.masses[0].points;
  const double from = points[3].second.first, to = points[6].second.first;
  points[4].second.first = from + (to - from) / 3.0;
  points[5].second.first = from + 2.0 * (to - from) / 3.0;
  filled.masses[0].key_frames = "{0,1,2,3,6,7,8,9,10,11}";
  CHECK(folder.read(filled).x_m.size() == 10);
  const core::TrackData without = folder.read(filled);
  const auto* const filled_in = tests::note_of<core::PositionsFilledIn>(without.notes);
  REQUIRE(filled_in != nullptr);
  CHECK(filled_in->positions == 2);
  filled.masses[0].key_frames = "";
  CHECK(folder.read(filled).x_m.size() == 12);
}

TEST_CASE("a point mass is asked for by name or number, and what there is is named") {
  const Folder folder;
  MadeProject project{{kAlong, kDown}};
  CHECK(taken_of(folder.read(project, {}, "ball")).mass == "ball");
  CHECK(taken_of(folder.read(project, {}, "Mass a")).mass == "mass A");
  CHECK(taken_of(folder.read(project, {}, "2")).mass == "ball");
  CHECK_THAT(folder.refusal(project),
             Contains("column: found point masses 1 \"mass A\", 2 \"ball\"") && Contains("--column"));
  CHECK_THAT(folder.refusal(project, "cart"),
             Contains("none of the name or number \"cart\"") && Contains("2 \"ball\""));
  project.masses[1].name = "mass A";
  CHECK_THAT(folder.refusal(project, "mass A"), Contains("several of the name"));
  project.masses[1] = kDown;
  project.masses[1].class_name = "cabrillo.tracker.DynamicParticle";
  CHECK_THAT(folder.refusal(project, "ball"), Contains("moves by a model"));
  CHECK(folder.read(project).x_m.size() == 12);  // the only one that was marked
  CHECK_THAT(folder.refusal(MadeProject{}), Contains("no point mass"));
}

TEST_CASE("a project in an archive is read, of several the one that has the mass") {
  const Folder folder;
  MadeProject one{{kAlong}}, two{{kDown, kAlong}};
  const auto in = [&](const std::vector<std::pair<std::string, std::string>>& entries, const std::string& mass) {
    return core::read_track(tests::write_zip(folder.temp / "made.trz", entries), {}, mass);
  };
  CHECK(in({{"videos/a.jpg", "no image"}, {"cups.trk", one.text()}}, "").x_m.size() == 12);
  // Apple's archiver adds its own; a name that leads out of the folder stays a name.
  CHECK(in({{"__MACOSX/._cups.trk", "?"}, {"../../cups.TRK", one.text()}}, "mass A").x_m.size() == 12);
  CHECK(taken_of(in({{"a.trk", one.text()}, {"b.trk", two.text()}}, "ball")).mass == "b.trk: ball");
  CHECK(taken_of(in({{"a.trk", one.text()}, {"b.trk", two.text()}}, "b.trk: mass A")).mass == "b.trk: mass A");
  CHECK_THROWS_WITH(in({{"a.trk", one.text()}, {"b.trk", two.text()}}, "mass A"), Contains("several of the name"));
  CHECK_THROWS_WITH(in({{"xl/cells.xml", "<x/>"}}, ""), Contains("0 Tracker projects") && Contains(".xlsx"));
  CHECK_THROWS_WITH(in({{"a.trk", "no XML"}}, ""), Contains("made.trz: a.trk"));
}

TEST_CASE("what is no project, or one that cannot be read, is refused with the reason") {
  const Folder folder;
  const auto text = [&](const std::string& content) {
    try {
      core::read_track(tests::write_text(folder.temp / "x.trk", content), {}, "");
    } catch (const base::InputError& error) {
      return std::string(error.what());
    }
    return std::string("read");
  };
  const std::string whole = MadeProject{{kAlong}}.text();
  CHECK(text(whole) == "read");
  CHECK(text("\xEF\xBB\xBF" + whole) == "read");
  CHECK_THAT(text(whole.substr(0, 900)), Contains("XML that breaks off"));
  CHECK_THAT(text("<html></html>"), Contains("XML with <html>"));
  CHECK_THAT(text("<object class=\"org.opensourcephysics.tools.Launcher\"/>"), Contains("XML with a Launcher"));
  // No entity is resolved: a document type is refused, whatever it holds.
  std::string with_type = whole;
  with_type.insert(with_type.find("<object"), "<!DOCTYPE x [<!ENTITY e SYSTEM \"/etc/passwd\">]>\n");
  CHECK_THAT(text(with_type), Contains("document type"));

  MadeProject project{{kAlong}};
  project.unit = "furlong";
  CHECK_THAT(folder.refusal(project), Contains("length_unit: found \"furlong\""));
  project.unit = "m";
  project.more = tests::property_text("referenceframe", "string", "cart");
  CHECK_THAT(folder.refusal(project), Contains("axes that move with \"cart\""));
  project.more = "";
  project.frame_ms = 0.0;
  CHECK_THAT(folder.refusal(project), Contains("clipcontrol.delta_t: found 0"));
  project.frame_ms = 10.0;
  project.axes = {{0, 0.0, 0.0, 0.0, 0.0}};
  CHECK_THAT(folder.refusal(project), Contains("xscale: found 0"));
  project.axes = {{3}};
  CHECK_THAT(folder.refusal(project), Contains("without those of frame 0"));
  project.axes = {{0}};
  project.masses[0].points.resize(5);
  CHECK_THAT(folder.refusal(project), Contains("5 positions, expected at least 8"));
  project.masses[0] = kAlong;
  project.masses[0].points.push_back({99'000'000, {0.0, 0.0}});
  CHECK_THAT(folder.refusal(project), Contains("13 positions over 99000000 steps"));
}

TEST_CASE("a table has no Y for downhill") {
  const Folder folder;
  std::string rows = "t_s,x_m\n";
  for (int i = 0; i < 9; ++i) rows += fmt::format("{},{}\n", i, i);
  const auto file = tests::write_text(folder.temp / "track.csv", rows);
  CHECK(core::read_track(file, core::Downhill::minus_x, "").x_m[3] == -3.0);
  CHECK(core::read_track(file, {}, "").x_m[3] == 3.0);
  CHECK_THROWS_WITH(core::read_track(file, core::Downhill::plus_y, ""), Contains("\"+Y\" for a table"));
}

TEST_CASE("Tracker's own example of falling cups is where an independent look at its images finds the cups") {
  const auto data = tests::real_data("falling-cups/CupsClips.zip");
  if (!data) return;
  const std::filesystem::path& archive = *data;
  for (const int cup : {3, 7}) {
    INFO("cup " << cup);
    const core::TrackData marked = core::read_track(archive, {}, fmt::format("cup {}", cup));
    const core::TrackData found = core::read_track_csv(archive.parent_path() / fmt::format("cup-{}.csv", cup), 1);
    CHECK(marked.x_m.size() == 9);
    CHECK(taken_of(marked).towards == "-Y");
    // Hand marks are good to a pixel or two, 11 mm each; the origins differ.
    double mean = 0.0, square = 0.0;
    int both = 0;
    for (std::size_t i = 0; i < marked.t_s.size(); ++i) {
      for (std::size_t k = 0; k < found.t_s.size(); ++k) {
        if (std::abs(found.t_s[k] - marked.t_s[i]) > 1e-4) continue;
        const double off = marked.x_m[i] - found.x_m[k];
        mean += off;
        square += off * off;
        ++both;
      }
    }
    REQUIRE(both >= 7);
    mean /= both;
    CHECK(std::sqrt(square / both - mean * mean) < 0.011);
  }
}
