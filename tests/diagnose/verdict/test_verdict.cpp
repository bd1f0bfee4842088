#include "diagnose/verdict/verdict.h"

#include <string>

#include "diagnose/verdict/named_explanation.h"
#include "tests/catch.h"

using namespace glidelab;

namespace {

diagnose::Hypothesis of(const std::vector<std::string>& ids, double probability) {
  diagnose::Hypothesis hypothesis;
  for (const std::string& id : ids) hypothesis.effects.push_back(diagnose::effect_index(id));
  hypothesis.probability = probability;
  return hypothesis;
}

std::string first(const diagnose::TrackSet& set, const std::vector<diagnose::Hypothesis>& by_falling_probability) {
  diagnose::Comparison comparison;
  comparison.all = by_falling_probability;
  const diagnose::Hypothesis* best = diagnose::best_named(set, comparison);
  return best == nullptr ? "" : std::string(diagnose::effect_list()[best->effects.back()].id);
}

}  // namespace

TEST_CASE("two names for one cause count together against one name for another") {
  diagnose::TrackSet tracks, films;
  films.images = true;
  CHECK(first(tracks, {of({"direction_asymmetry"}, 0.38), of({"scale_error"}, 0.32), of({"frame_rate_error"}, 0.3)}) ==
        "scale_error");
  CHECK(first(tracks, {of({"direction_asymmetry"}, 0.7), of({"scale_error"}, 0.16), of({"frame_rate_error"}, 0.14)}) ==
        "direction_asymmetry");
  // Beside another effect as well. A pair is another cause than either effect alone.
  CHECK(first(tracks, {of({"stribeck", "direction_asymmetry"}, 0.4), of({"stribeck", "frame_rate_error"}, 0.3),
                       of({"scale_error", "stribeck"}, 0.2), of({"scale_error"}, 0.1)}) == "frame_rate_error");
  // Only images can tell whether the camera or the table shakes.
  const std::vector<diagnose::Hypothesis> shaken = {of({"stribeck"}, 0.4), of({"camera_motion"}, 0.35),
                                                    of({"base_vibration"}, 0.25)};
  CHECK(first(tracks, shaken) == "camera_motion");
  CHECK(first(films, shaken) == "stribeck");
  CHECK(first(tracks, {of({}, 1.0)}).empty());
}

TEST_CASE("the likeliest cause leads, even if its probability is shared out among many pairs") {
  const diagnose::TrackSet tracks;
  // The bow is in 0.6 of all, but not in the likeliest pair.
  CHECK(first(tracks, {of({"stribeck", "perspective_error"}, 0.3), of({"tether", "track_bow"}, 0.22),
                       of({"end_stop", "track_bow"}, 0.2), of({"stribeck", "track_bow"}, 0.18)}) == "track_bow");
  CHECK(first(tracks, {of({"stribeck", "perspective_error"}, 0.62), of({"tether", "track_bow"}, 0.22),
                       of({"end_stop", "track_bow"}, 0.16)}) == "perspective_error");
  // Scatter beside a cause never leads; by itself it is a cause.
  CHECK(first(tracks, {of({"heavy_tailed_noise", "stribeck"}, 0.4), of({"heavy_tailed_noise", "track_bow"}, 0.35),
                       of({"heavy_tailed_noise"}, 0.25)}) == "stribeck");
  CHECK(first(tracks, {of({"heavy_tailed_noise"}, 0.7), of({"heavy_tailed_noise", "stribeck"}, 0.3)}) ==
        "heavy_tailed_noise");
}

TEST_CASE("of an explanation the causes that are likelier than not keep their name, or the likeliest") {
  diagnose::Comparison comparison;
  const auto part = [&](const diagnose::TrackSet& set, const std::vector<diagnose::Hypothesis>& all) {
    comparison.all = all;
    for (diagnose::Hypothesis& one : comparison.all) one.fit = 1;
    const diagnose::Hypothesis* likely = diagnose::likely_part(set, comparison, comparison.all.front());
    return likely != nullptr ? likely->effects : std::vector<std::size_t>();
  };
  const auto only = [](const std::string& id) { return of({id}, 0.0).effects; };
  const diagnose::TrackSet tracks;
  diagnose::TrackSet films;
  films.images = true;
  // The drag is in 0.9 of all, the bow in 0.45 and in 0.5.
  CHECK(part(tracks, {of({"quadratic_drag", "track_bow"}, 0.45), of({"quadratic_drag"}, 0.45)}) ==
        only("quadratic_drag"));
  CHECK(part(tracks, {of({"quadratic_drag", "track_bow"}, 0.5), of({"quadratic_drag"}, 0.4)}).empty());
  // Neither in half of all: the likeliest, whatever their order.
  CHECK(part(tracks, {of({"quadratic_drag", "track_bow"}, 0.3), of({"track_bow"}, 0.15),
                      of({"quadratic_drag"}, 0.1)}) == only("track_bow"));
  // A shaking camera and a shaking table are one cause of tracks, in 0.6 of all. Images tell them apart.
  const std::vector<diagnose::Hypothesis> shaken = {of({"quadratic_drag", "camera_motion"}, 0.35),
                                                    of({"quadratic_drag", "base_vibration"}, 0.25),
                                                    of({"quadratic_drag"}, 0.3)};
  CHECK(part(tracks, shaken).empty());
  CHECK(part(films, shaken) == only("quadratic_drag"));
  // Two waves are not each as likely as one of them.
  const std::size_t camera = diagnose::effect_index("camera_motion"), table = diagnose::effect_index("base_vibration");
  comparison.effect_probability.assign(diagnose::effect_list().size(), 0.0);
  comparison.effect_probability[camera] = 0.9;
  comparison.effect_probability[table] = 0.4;
  CHECK(part(tracks, {of({"camera_motion", "base_vibration"}, 0.4), of({"camera_motion"}, 0.5)}) ==
        only("camera_motion"));
  comparison.effect_probability[table] = 0.6;
  CHECK(part(tracks, {of({"camera_motion", "base_vibration"}, 0.6), of({"camera_motion"}, 0.3)}).empty());
  // A bumper and a cable that do the same beside the shaking are one cause together, and not if one of them does less.
  std::vector<diagnose::Hypothesis> ends = {of({"camera_motion", "end_stop"}, 0.4),
                                            of({"camera_motion", "tether"}, 0.3), of({"camera_motion"}, 0.3)};
  ends[0].gain = ends[1].gain = 40.0;
  ends[0].log_evidence = ends[1].log_evidence = 30.0;
  CHECK(part(tracks, ends).empty());
  ends[0].probability = 0.35;  // a third of all
  ends[1].probability = 0.25;
  CHECK(part(tracks, ends).empty());
  ends[0].probability = 0.31;
  ends[1].probability = 0.29;
  CHECK(part(tracks, ends) == only("camera_motion"));
  ends[0].probability = 0.4;
  ends[1].probability = 0.3;
  ends[1].gain = 30.0;
  CHECK(part(tracks, ends) == only("camera_motion"));
  // A single cause has no part, and a part without a fit cannot be reported.
  CHECK(part(tracks, {of({"quadratic_drag"}, 0.4)}).empty());
  CHECK(part(tracks, {of({"quadratic_drag", "track_bow"}, 0.45), of({"stribeck"}, 0.45)}).empty());
}

TEST_CASE("beside a remainder two effects are told apart by their probabilities, whatever their evidence says") {
  diagnose::Comparison comparison;
  comparison.all = {of({"friction_drift"}, 0.3), of({"clip_scatter"}, 0.2), of({"track_bow"}, 0.09)};
  comparison.all[0].gain = comparison.all[0].log_evidence = 60.0;
  const auto equals = [&] {
    return diagnose::not_told_apart(comparison, comparison.all.front(), comparison.all.front().effects.front(), false);
  };
  CHECK(equals().empty());  // 60 in log evidence, by the noise alone
  for (diagnose::Hypothesis& one : comparison.all) one.left = 0.0;
  CHECK(equals() == of({"clip_scatter"}, 0.0).effects);
  comparison.all[1].left = 0.9;  // it leaves the gap
  CHECK(equals().empty());
}

TEST_CASE("several names that these data cannot tell apart count together against one name for another cause") {
  const diagnose::TrackSet tracks;
  diagnose::Comparison comparison;
  // A wrong mass by either name is in 0.52 of all, the drag in 0.48.
  for (std::size_t e = 0; e < diagnose::effect_list().size(); ++e) comparison.alike.push_back(e);
  comparison.alike[diagnose::effect_index("force_gain")] = diagnose::effect_index("mass_error");
  comparison.all = {of({"quadratic_drag", "stribeck"}, 0.3), of({"mass_error"}, 0.27), of({"force_gain"}, 0.25),
                    of({"quadratic_drag"}, 0.18)};
  CHECK(diagnose::best_named(tracks, comparison)->effects == of({"mass_error"}, 0.0).effects);
  comparison.alike.clear();
  CHECK(diagnose::best_named(tracks, comparison)->effects == of({"quadratic_drag", "stribeck"}, 0.0).effects);
}

TEST_CASE("what one clip cannot support goes to the unknown, or from it, and the sum stays one") {
  diagnose::Diagnosis sure;
  sure.none = 1.0;
  diagnose::cap_probabilities(0.999, sure);
  CHECK(sure.none == Approx(0.999).epsilon(1e-12));
  CHECK(sure.unknown == Approx(0.001).epsilon(1e-9));
  diagnose::Diagnosis unknown;
  unknown.unknown = 1.0;
  diagnose::cap_probabilities(0.999, unknown);
  CHECK(unknown.unknown == Approx(0.999).epsilon(1e-12));
  CHECK(unknown.none == Approx(0.001).epsilon(1e-9));
  // Two names of one cause that is certain; each explanation and the set of both keep their ratios.
  diagnose::Diagnosis named;
  named.unknown = 2e-4;
  named.effects.resize(1);
  named.effects.front().probability = 0.6;
  named.effects.front().joint_probability = 0.9998;
  named.effects.front().alike = {{"scale_error", "", 0.6}, {"frame_rate_error", "", 0.3998}};
  named.ranking.resize(2);
  named.ranking[0].probability = 0.6;
  named.ranking[1].probability = 0.3998;
  diagnose::cap_probabilities(0.999, named);
  CHECK(named.effects.front().joint_probability == Approx(0.999).epsilon(1e-12));
  CHECK(named.ranking[0].probability + named.ranking[1].probability + named.unknown + named.none ==
        Approx(1.0).epsilon(1e-12));
  CHECK(*named.effects.front().alike[0].probability + *named.effects.front().alike[1].probability ==
        Approx(0.999).epsilon(1e-12));
  // Nothing is too likely: nothing changes.
  diagnose::Diagnosis open;
  open.none = 0.7;
  open.unknown = 0.3;
  diagnose::cap_probabilities(0.999, open);
  CHECK(open.none == 0.7);
  CHECK(open.unknown == 0.3);
}

TEST_CASE("an effect that acts beside another is no other name for it") {
  diagnose::Comparison comparison;
  const auto add = [&](const std::vector<std::string>& ids, double probability) {
    diagnose::Hypothesis one = of(ids, probability);
    one.gain = 40.0;
    one.log_evidence = 30.0;
    comparison.all.push_back(one);
  };
  add({"base_vibration", "perspective_error"}, 0.4);
  add({"base_vibration", "late_release"}, 0.4);
  const std::size_t pattern = diagnose::effect_index("perspective_error"),
                    hand = diagnose::effect_index("late_release");
  const auto others = [&] { return diagnose::not_told_apart(comparison, comparison.all.front(), pattern, false); };
  CHECK(others() == std::vector{hand});
  comparison.all[0].probability = comparison.all[1].probability = 0.05;
  add({"base_vibration", "perspective_error", "late_release"}, 0.8);
  CHECK(others().empty());
}
