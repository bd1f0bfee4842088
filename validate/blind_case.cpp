#include "validate/blind_case.h"

#include <fmt/format.h>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "base/dense.h"
#include "base/errors.h"
#include "base/staged_output.h"
#include "validate/blind_effects.h"

namespace glidelab::validate {
namespace {

// Of 100 cases: 20 nominal, 50 with one effect, 12 with two, 18 with one outside.
constexpr double kNone = 0.20, kSingle = 0.70, kPair = 0.82;
constexpr double kLeastGain = 8.0, kMostGain = 1500.0;  // a factor of 3000 of all, and of odds from 1 to a thousand
constexpr double kLeastPairGain = 30.0;                 // what each of two would gain beside the other
constexpr double kReached = 0.9;  // of the wanted gain, where the largest size is too small for it
constexpr int kMostDraws = 400, kBisections = 24;

using Seen = std::vector<std::vector<double>>;

struct Put {
  const BlindEffect* effect = nullptr;
  double size = 0.0;
};

Seen seen_with(const BlindDesign& design, const std::vector<Put>& puts) {
  Seen seen;
  for (std::size_t c = 0; c < design.clips.size(); ++c) {
    BlindFilm film = nominal_film(design, design.clips[c]);
    for (const Put& put : puts) put.effect->put(put.size, c, film);
    seen.push_back(seen_positions(design.clips[c], film));
  }
  return seen;
}

/// Positions that count, one after the other, over the noise; where one of the two rests, both say nothing.
Eigen::VectorXd difference(const Seen& a, const Seen& b, double sd) {
  std::vector<double> d;
  for (std::size_t c = 0; c < a.size(); ++c) {
    for (std::size_t k = 0; k < a[c].size(); ++k) {
      const double off = (a[c][k] - b[c][k]) / sd;
      d.push_back(std::isfinite(off) ? off : 0.0);
    }
  }
  return Eigen::Map<const Eigen::VectorXd>(d.data(), std::ssize(d));
}

/// What a fit of the nominal law may change, with what is stated of it.
struct Nuisance {
  std::function<void(BlindDesign&, double)> change;
  double step = 0.0;
  double most = 0.0;                                    // that it may change by at once
  double sd = std::numeric_limits<double>::infinity();  // as it is stated
  std::optional<std::size_t> clip = {};                 // of one clip only
};

std::vector<Nuisance> nuisances(const BlindDesign& design) {
  constexpr double kFree = std::numeric_limits<double>::infinity();
  std::vector<Nuisance> list;
  list.push_back({[](BlindDesign& d, double by) { d.k_n_s_m += by; }, 1e-4 * design.k_n_s_m, 0.4 * design.k_n_s_m});
  list.push_back({[](BlindDesign& d, double by) { d.mu += by; }, 1e-6, 0.02});
  for (std::size_t g = 0; g < design.groups.size(); ++g) {
    list.push_back({[g](BlindDesign& d, double by) { d.groups[g].true_rad += by; }, 1e-6, 0.03,
                    design.groups[g].stated_sd_rad.value_or(0.35)});
  }
  for (std::size_t m = 0; m < design.masses.size(); ++m) {
    if (!(design.masses[m].sd_kg > 0.0)) continue;
    list.push_back({[m](BlindDesign& d, double by) { d.masses[m].true_kg += by; }, 1e-5, 0.01, design.masses[m].sd_kg});
  }
  for (std::size_t c = 0; c < design.clips.size(); ++c) {
    list.push_back({[c](BlindDesign& d, double by) { d.clips[c].x0_m += by; }, 1e-5, 0.1, kFree, c});
    list.push_back({[c](BlindDesign& d, double by) { d.clips[c].v0_m_s += by; }, 1e-5, 0.3, kFree, c});
  }
  return list;
}

/// The nominal law's fit to positions that something else made: Gauss and Newton's steps from the true values.
class NominalFit {
 public:
  explicit NominalFit(const BlindDesign& design)
      : design_(design), list_(nuisances(design)), without_(seen_with(design, {})) {}

  /// Half of chi² that is left; a size of `more` is fitted as well.
  double misfit(const Seen& seen, const std::optional<Eigen::VectorXd>& more = {}) const {
    constexpr int kMostSteps = 6;
    constexpr double kSettled = 0.01;  // of chi²: far less than the classes of strength are wide
    const Eigen::Index many = std::ssize(list_) + (more ? 1 : 0);
    BlindDesign fitted = design_;
    Eigen::VectorXd at = Eigen::VectorXd::Zero(many);
    double last = 0.0;
    for (int step = 0; step < kMostSteps; ++step) {
      const Seen now = step == 0 ? without_ : seen_with(fitted, {});
      const Eigen::VectorXd d = difference(seen, now, design_.noise_sd_m);
      Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(d.size() + many, many);
      Eigen::VectorXd left = Eigen::VectorXd::Zero(columns.rows()), scale = Eigen::VectorXd::Ones(many);
      left.head(d.size()) = d;
      for (Eigen::Index n = 0; n < std::ssize(list_); ++n) {
        const Nuisance& one = list_[static_cast<std::size_t>(n)];
        columns.col(n).head(d.size()) = derivative(fitted, one, now);
        if (!std::isfinite(one.sd)) continue;
        columns(d.size() + n, n) = 1.0 / one.sd;
        left[d.size() + n] = -at[n] / one.sd;
      }
      if (more) {
        columns.col(many - 1).head(d.size()) = *more;
        left.head(d.size()) -= at[many - 1] * *more;
      }
      // Columns in units of what the data know of them: least squares are then well conditioned.
      for (Eigen::Index n = 0; n < many; ++n) {
        scale[n] = std::max(columns.col(n).norm(), 1e-12);
        columns.col(n) /= scale[n];
      }
      const Eigen::VectorXd by = base::least_squares(columns, left);
      left -= base::product(columns, by);
      const double chi2 = left.squaredNorm();
      if (!std::isfinite(chi2)) return 0.0;
      if (step > 0 && std::abs(chi2 - last) <= kSettled * chi2) return 0.5 * chi2;
      last = chi2;
      const Eigen::VectorXd change = by.cwiseQuotient(scale);
      double part = 1.0;  // of a step that would leave the neighbourhood in which it was found
      for (std::size_t n = 0; n < list_.size(); ++n) {
        part = std::min(part, list_[n].most / std::max(1e-300, std::abs(change[static_cast<Eigen::Index>(n)])));
      }
      at += part * change;
      fitted = design_;
      for (std::size_t n = 0; n < list_.size(); ++n) list_[n].change(fitted, at[static_cast<Eigen::Index>(n)]);
    }
    return 0.5 * last;
  }

  const Seen& without() const { return without_; }

 private:
  Eigen::VectorXd derivative(const BlindDesign& at, const Nuisance& one, const Seen& now) const {
    BlindDesign changed = at;
    one.change(changed, one.step);
    Seen seen = now;
    for (std::size_t c = 0; c < at.clips.size(); ++c) {
      if (!one.clip || *one.clip == c) {
        seen[c] = seen_positions(changed.clips[c], nominal_film(changed, changed.clips[c]));
      }
    }
    return difference(seen, now, design_.noise_sd_m) / one.step;
  }

  const BlindDesign& design_;
  std::vector<Nuisance> list_;
  Seen without_;
};

struct Detection {
  explicit Detection(const BlindDesign& drawn) : design(drawn), nominal(drawn) {
    for (const BlindClip& clip : drawn.clips) {
      const BlindFilm film = nominal_film(drawn, clip);
      speed.emplace_back();
      for (const BlindSample& s : blind_motion(film.law, clip.x0_m, clip.v0_m_s, film.true_t_s)) {
        speed.back().push_back(s.v_m_s);
      }
    }
  }
  double gain(const BlindEffect& effect, double size) const {
    if (effect.gain) return effect.gain(size, design.noise_sd_m, speed);
    return nominal.misfit(seen_with(design, {{&effect, size}}));
  }
  /// With something else that acts and is in the model already, to first order in its size.
  double gain_beside(const Put& mine, const Put& other) const {
    const Eigen::VectorXd of_other = difference(seen_with(design, {other}), nominal.without(), design.noise_sd_m);
    return nominal.misfit(seen_with(design, {mine, other}), of_other);
  }

  const BlindDesign& design;
  NominalFit nominal;
  std::vector<std::vector<double>> speed;
};

struct Strength {
  double size = 0.0, gain = 0.0;
};

/// The size at which the effect gains what is wanted; nothing where its largest size does not come near it. A gain
/// grows about as the square of the size; where it does not (whole frames that are missing), the bracket halves.
std::optional<Strength> size_for(const Detection& detection, const BlindEffect& effect, double wanted) {
  constexpr double kNear = 0.05;
  double low = 0.0, high = effect.largest;
  Strength at{high, detection.gain(effect, high)};
  if (!(at.gain > kReached * wanted)) return std::nullopt;
  Strength best = at;
  for (int i = 0; i < kBisections && std::abs(at.gain / wanted - 1.0) > kNear; ++i) {
    double size = at.size * std::sqrt(wanted / std::max(at.gain, 1e-6 * wanted));
    if (!(size > low) || !(size < high) || i % 4 == 3) size = 0.5 * (low + high);
    at = {size, detection.gain(effect, size)};
    if (at.gain < wanted) {
      low = size;
    } else {
      high = size;
      best = at;
    }
  }
  return std::abs(at.gain / wanted - 1.0) <= kNear ? at : best;
}

BlindCause cause_of(const BlindEffect& effect, double size, double gain) {
  return {effect.id, size, effect.truth ? effect.truth(size) : std::map<std::string, double>{}, effect.variable, gain};
}

std::string one_of(const std::vector<std::string>& ids, BlindRandom& random) {
  return ids[std::min(ids.size() - 1, static_cast<std::size_t>(uniform(random, 0.0, static_cast<double>(ids.size()))))];
}

/// Draws effects for a design; false where they cannot be seen in it.
bool draw_causes(BlindCase& one, const BlindDraw& draw, BlindRandom& random, std::vector<BlindEffect>& effects) {
  if (one.kind == BlindKind::none) return true;
  const Detection detection(one.design);
  const std::size_t many = one.kind == BlindKind::pair ? 2 : 1;
  const auto& ids = one.kind == BlindKind::outside ? outside_effects() : library_effects();
  for (std::size_t e = 0; e < many; ++e) {
    const std::string id = draw.only.empty() ? one_of(ids, random) : draw.only;
    if (e == 1 && id == effects.front().id) return false;
    const double wanted = log_uniform(random, many == 2 ? kLeastPairGain : kLeastGain, kMostGain);
    effects.push_back(draw_effect(id, one.design, random));
    const std::optional<Strength> found = size_for(detection, effects.back(), wanted);
    if (!found) return false;
    one.causes.push_back(cause_of(effects.back(), found->size, found->gain));
  }
  if (many == 1) return true;
  for (std::size_t e = 0; e < 2; ++e) {
    const BlindEffect &mine = effects[e], &other = effects[1 - e];
    if (mine.gain || other.gain) continue;  // of single frames: nothing smooth takes it up
    one.causes[e].gain = detection.gain_beside({&mine, one.causes[e].size}, {&other, one.causes[1 - e].size});
    if (one.causes[e].gain < 0.5 * kLeastPairGain) return false;  // the two look alike here
  }
  return true;
}

void film_case(BlindCase& one, const std::vector<BlindEffect>& effects, BlindRandom& random) {
  std::vector<Put> puts;
  for (std::size_t e = 0; e < effects.size(); ++e) puts.push_back({&effects[e], one.causes[e].size});
  // A camera films on when the glider rests: positions there are those of the rest.
  for (std::size_t c = 0; c < one.design.clips.size(); ++c) {
    BlindFilm film = nominal_film(one.design, one.design.clips[c]);
    for (const Put& put : puts) put.effect->put(put.size, c, film);
    const auto motion = blind_motion(film.law, one.design.clips[c].x0_m, one.design.clips[c].v0_m_s, film.true_t_s);
    one.x_m.emplace_back();
    for (std::size_t k = 0; k < motion.size(); ++k) {
      double x = motion[k].x_m;
      for (const auto& see : film.seen) x = see(x, film.true_t_s[k]);
      one.x_m.back().push_back(x + film.off_m[k] + one.design.noise_sd_m * normal(random));
    }
  }
}

bool all_finite(const std::vector<double>& x) {
  return std::all_of(x.begin(), x.end(), [](double value) { return std::isfinite(value); });
}

BlindKind kind_of(BlindRandom& random, const BlindDraw& draw) {
  const double lot = uniform(random, 0.0, 1.0);
  if (!draw.only.empty()) {
    const auto& outside = outside_effects();
    return std::find(outside.begin(), outside.end(), draw.only) != outside.end() ? BlindKind::outside
                                                                                 : BlindKind::single;
  }
  return lot < kNone     ? BlindKind::none
         : lot < kSingle ? BlindKind::single
         : lot < kPair   ? BlindKind::pair
                         : BlindKind::outside;
}

}  // namespace

std::string_view word(BlindKind kind) {
  switch (kind) {
    case BlindKind::none:
      return "none";
    case BlindKind::single:
      return "single";
    case BlindKind::pair:
      return "pair";
    case BlindKind::outside:
      return "outside";
  }
  return "none";
}

BlindCase make_blind_case(std::uint64_t seed, std::size_t index, const BlindDraw& draw) {
  std::seed_seq sequence{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                         static_cast<std::uint32_t>(index)};
  BlindRandom random(sequence);
  const BlindKind kind = kind_of(random, draw);
  for (int attempt = 0; attempt < kMostDraws; ++attempt) {
    BlindCase one;
    one.seed = seed;
    one.index = index;
    one.kind = kind;
    one.design = draw_design(random);
    std::vector<BlindEffect> effects;
    if (!draw_causes(one, draw, random, effects)) continue;
    film_case(one, effects, random);
    if (std::all_of(one.x_m.begin(), one.x_m.end(), all_finite)) return one;
  }
  throw base::NumericalError(
      fmt::format("blind case {} of seed {}: none of {} designs shows the effect", index, seed, kMostDraws));
}

void write_blind_folder(const BlindCase& one, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder / "tracks");
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  std::string toml = fmt::format("format = 1\nname = \"case {}\"\ngravity_m_s2 = {}\n\n[track]\ndownhill = \"+X\"\n",
                                 one.index, one.design.gravity_m_s2);
  for (std::size_t c = 0; c < one.design.clips.size(); ++c) {
    const BlindClip& clip = one.design.clips[c];
    const BlindGroup& group = one.design.groups[clip.group];
    const BlindMass& mass = one.design.masses[clip.mass];
    toml += fmt::format(
        "\n[[clip]]\nname = \"{0}\"\ntrack = \"tracks/{0}.csv\"\nmass_kg = {1:.6g}\nincline_deg = {2:.6g}\nlaunched = "
        "\"{3}\"\ngroup = \"{4}\"\n",
        clip.name, mass.stated_kg, group.stated_rad * kDegrees, clip.v0_m_s < 0.0 ? "up" : "down", group.name);
    if (group.stated_sd_rad) toml += fmt::format("incline_sd_deg = {:.6g}\n", *group.stated_sd_rad * kDegrees);
    if (mass.sd_kg > 0.0) toml += fmt::format("mass_sd_kg = {:.6g}\n", mass.sd_kg);
    std::string csv = "t_s,x_m\n";
    for (std::size_t k = 0; k < one.x_m[c].size(); ++k) {
      csv += fmt::format("{:.9f},{:.8f}\n", static_cast<double>(k) / clip.rate_hz, one.x_m[c][k]);
    }
    base::write_file(folder / "tracks" / (clip.name + ".csv"), csv);
  }
  base::write_file(folder / "experiment.toml", toml);
}

std::string blind_truth_json(const BlindCase& one) {
  nlohmann::ordered_json truth;
  truth["format"] = 1;
  truth["seed"] = one.seed;
  truth["case"] = one.index;
  truth["kind"] = word(one.kind);
  truth["causes"] = nlohmann::ordered_json::array();
  for (const BlindCause& cause : one.causes) {
    nlohmann::ordered_json object{{"id", cause.id}, {"size", cause.size}, {"log_likelihood_gain", cause.gain}};
    object["parameters"] = cause.parameters;
    if (!cause.variable.empty()) object["variable"] = cause.variable;
    truth["causes"].push_back(std::move(object));
  }
  truth["k_n_s_m"] = one.design.k_n_s_m;
  truth["mu"] = one.design.mu;
  truth["noise_sd_m"] = one.design.noise_sd_m;
  truth["alpha_rad"] = nlohmann::ordered_json::object();
  for (const BlindGroup& group : one.design.groups) truth["alpha_rad"][group.name] = group.true_rad;
  truth["mass_kg"] = nlohmann::ordered_json::array();
  for (const BlindMass& mass : one.design.masses) truth["mass_kg"].push_back(mass.true_kg);
  return truth.dump(2) + "\n";
}

}  // namespace glidelab::validate
