#include "validate/blind/case/everyday_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/errors.h"
#include "base/text/json_text.h"
#include "validate/blind/case/blind_effects.h"
#include "validate/blind/case/blind_strength.h"
#include "validate/blind/case/everyday_causes.h"
#include "validate/blind/case/everyday_law.h"
#include "validate/random_use.h"

namespace glidelab::validate {
namespace {

constexpr double kUpToOne = 0.50, kUpToTwo = 0.70, kUpToImperfect = 0.85;  // of 100 cases 50, 20, 15 and 15
constexpr double kMostExcess = 40.0;                                       // a gap of 6.4
constexpr int kMostEverydayDraws = 600;
constexpr int kDesignsPerCause = 8;    // designs tried per cause: none may show a weak effect
constexpr double kLongestTrack = 1.3;  // m, on either side of the middle
constexpr double kFilmedAtRest = 0.3;  // s
constexpr double kFirstGuess = 0.2;    // of the largest size
constexpr double kNoExcess = 1e-12;

/// The requirements of a case; they stay fixed while designs are drawn.
struct Wanted {
  EverydayClass kind = EverydayClass::one;
  bool strong = false;
  std::string only;
};

/// Number of frames until the glider leaves the track or has rested for a while; the causes hardly affect this.
std::size_t frames_on_track(const BlindDesign& design, const BlindClip& clip, double origin) {
  const BlindFilm film = nominal_film(design, clip);
  const auto motion = blind_motion(film.law, clip.x0_m, clip.v0_m_s, film.true_t_s);
  double rested = 0.0;
  for (std::size_t k = 1; k < motion.size(); ++k) {
    rested = motion[k].v_m_s == 0.0 ? rested + 1.0 / clip.rate_hz : 0.0;
    if (!(std::abs(motion[k].x_m - origin) < kLongestTrack) || rested > kFilmedAtRest) return k;
  }
  return motion.size();
}

double seen_share(const std::vector<double>& shares) {
  double sum = 0.0;
  for (const double share : shares) sum += share;
  return sum;
}

/// The size of an effect that causes this excess to first order, within a tenth, searched for from `guess`; empty if
/// its largest size does not reach it.
std::optional<double> size_of_excess(const BlindDetection& detection, const BlindEffect& effect, double wanted,
                                     double guess) {
  constexpr double kNearWanted = 0.1;
  constexpr int kMostSizeSteps = 16;
  double low = 0.0, high = effect.largest, size = std::min(guess, high);
  if (!(high > 0.0)) return std::nullopt;
  for (int i = 0; i < kMostSizeSteps; ++i) {
    const double at = detection.first_order_excess({{&effect, size}}, {});
    if (std::abs(at / wanted - 1.0) <= kNearWanted) return size;
    if (at < wanted && size == effect.largest) return std::nullopt;
    (at < wanted ? low : high) = size;
    const double next = size * std::sqrt(wanted / std::max(at, 1e-6 * wanted));
    if (next >= effect.largest && high == effect.largest) {
      size = high;
    } else {
      size = next > low && next < high && i % 4 != 3 ? next : 0.5 * (low + high);
    }
  }
  return std::nullopt;
}

/// The parts of a case before it is filmed.
struct Drawn {
  std::vector<BlindEffect> effects;
  std::vector<double> sizes;
  std::vector<EverydayImperfection> imperfections;
  std::vector<double> own_excess;  // excess of each at size 1 of its effect
  double imperfection_size = 0.0;
  BlindEffect all_imperfections;

  std::vector<BlindPut> causes() const {
    std::vector<BlindPut> puts;
    for (std::size_t e = 0; e < effects.size(); ++e) puts.push_back({&effects[e], sizes[e]});
    return puts;
  }
  std::vector<BlindPut> everything() const {
    std::vector<BlindPut> puts = causes();
    puts.push_back({&all_imperfections, imperfection_size});
    return puts;
  }
};

/// Shares by their definition, the main cause moved to the front; false if they are not as wanted.
bool measure(const BlindDetection& detection, const Wanted& wanted, Drawn& drawn, EverydayTruth& truth) {
  const auto nominal = detection.excess(drawn.everything(), {});
  if (!nominal) return false;
  truth.excess = *nominal;
  if (drawn.effects.empty()) return true;
  if (drawn.effects.size() == 2) {
    const auto puts = drawn.causes();
    const auto first = detection.excess(drawn.everything(), {puts[0]});
    const auto second = detection.excess(drawn.everything(), {puts[1]});
    if (!first || !second) return false;
    if (*second < *first) {
      std::swap(drawn.effects[0], drawn.effects[1]);
      std::swap(drawn.sizes[0], drawn.sizes[1]);
    }
    truth.shares.push_back(1.0 - std::min(*first, *second) / *nominal);
  }
  const auto left = detection.excess(drawn.everything(), drawn.causes());
  if (!left) return false;
  truth.remainder = *left / *nominal;
  truth.shares.push_back(1.0 - truth.remainder - seen_share(truth.shares));
  if (wanted.kind == EverydayClass::two && truth.shares.back() < kLeastSecond) return false;
  return truth.remainder >= kLeastImperfections && truth.remainder <= kMostImperfections &&
         truth.shares.front() >= truth.shares.back() && (*nominal >= kStrongExcess) == wanted.strong &&
         *nominal >= kModerateExcess;
}

std::vector<std::string> fair_names(const Drawn& drawn) {
  std::vector<std::string> ids;
  for (const BlindEffect& effect : drawn.effects) ids.push_back(effect.id);
  return ids;
}

bool draw_sizes(const BlindDetection& detection, const Wanted& wanted, BlindRandom& random, const EverydayCase& one,
                Drawn& drawn) {
  const double excess = wanted.strong ? log_uniform(random, kStrongExcess, kMostExcess)
                                      : log_uniform(random, kModerateExcess, kStrongExcess);
  const double of_imperfections = log_uniform(random, 1.2 * kLeastImperfections, 0.9 * kMostImperfections);
  const double of_first = uniform(random, 0.5, 0.66);
  for (std::size_t e = 0; e < drawn.effects.size(); ++e) {
    const double part = drawn.effects.size() < 2 ? 1.0 : e == 0 ? of_first : 1.0 - of_first;
    const auto size = size_of_excess(detection, drawn.effects[e], part * (1.0 - of_imperfections) * excess,
                                     kFirstGuess * drawn.effects[e].largest);
    if (!size) return false;
    drawn.sizes.push_back(*size);
  }
  if (drawn.effects.size() == 2) {
    const auto puts = drawn.causes();
    const double both = detection.first_order_excess(puts, {});
    const double left =
        std::min(detection.first_order_excess(puts, {puts[0]}), detection.first_order_excess(puts, {puts[1]}));
    if ((1.0 - of_imperfections) * left < kLeastSecond * both) return false;  // the two look alike here
  }
  const int of_noise = (one.noise.clicked_sd_m > 0.0 ? 1 : 0) + (one.noise.rounded_m > 0.0 ? 1 : 0);
  const auto many = static_cast<std::size_t>(std::max(2, one_of(random, {3, 4, 5}) - of_noise));
  drawn.imperfections = draw_imperfections(many, fair_names(drawn), one.design, random);
  double weights = 0.0;
  for (EverydayImperfection& imperfection : drawn.imperfections) {
    const double own = detection.first_order_excess({{&imperfection.effect, 1.0}}, {});
    const double weight = log_uniform(random, 0.5, 2.0);
    weights += weight;
    drawn.own_excess.push_back(own);
    imperfection.part = std::sqrt(weight * of_imperfections * excess / std::max(own, kNoExcess));
  }
  for (EverydayImperfection& imperfection : drawn.imperfections)
    imperfection.part = std::min(imperfection.part / std::sqrt(weights), imperfection.effect.largest);
  drawn.all_imperfections = all_of_imperfections(drawn.imperfections);
  const auto size = size_of_excess(detection, drawn.all_imperfections, of_imperfections * excess, 1.0);
  if (!size) return false;
  drawn.imperfection_size = *size;
  return true;
}

std::vector<std::vector<double>> filmed(const BlindDesign& design, const std::vector<BlindPut>& puts) {
  std::vector<std::vector<double>> x_m;
  for (std::size_t c = 0; c < design.clips.size(); ++c) {
    BlindFilm film = nominal_film(design, design.clips[c]);
    for (const BlindPut& put : puts) put.effect->put(put.size, c, film);
    const auto motion = blind_motion(film.law, design.clips[c].x0_m, design.clips[c].v0_m_s, film.true_t_s);
    x_m.emplace_back();
    for (std::size_t k = 0; k < motion.size(); ++k) {
      double x = motion[k].x_m;
      for (const auto& see : film.seen) x = see(x, film.true_t_s[k]);
      x_m.back().push_back(x + film.off_m[k]);
    }
  }
  return x_m;
}

bool is_finite(const std::vector<std::vector<double>>& x_m) {
  return std::all_of(x_m.begin(), x_m.end(), [](const auto& clip) {
    return std::all_of(clip.begin(), clip.end(), [](double x) { return std::isfinite(x); });
  });
}

void tell_truth(const Drawn& drawn, EverydayCase& one) {
  double points = 0.0;
  for (const auto& clip : one.x_m) points += static_cast<double>(clip.size());
  for (std::size_t e = 0; e < drawn.effects.size(); ++e) {
    const BlindEffect& effect = drawn.effects[e];
    const auto parameters = effect.truth ? effect.truth(drawn.sizes[e]) : std::map<std::string, double>{};
    one.causes.push_back({effect.id, drawn.sizes[e], parameters, effect.variable,
                          0.5 * points * one.truth.shares[e] * one.truth.excess});
    const auto end = parameters.find("end");
    one.truth.equals.push_back(equals_of(effect.id, one.design, end != parameters.end() && end->second > 0.0));
  }
  for (std::size_t d = 0; d < drawn.imperfections.size(); ++d) {
    const EverydayImperfection& imperfection = drawn.imperfections[d];
    const double size = imperfection.size_at(drawn.imperfection_size);
    one.truth.imperfections.push_back({imperfection.id, size * imperfection.amplitude, imperfection.unit,
                                       size * size * drawn.own_excess[d], imperfection.effects});
  }
  one.truth.configurations = everyday_configurations(one.design, drawn.causes(), one.x_m);
}

BlindRandom random_of(std::uint64_t seed, std::size_t index) {
  return random_engine(RandomUse::everyday_case, seed, index);
}

Wanted draw_wanted(BlindRandom& random, const EverydayDraw& draw) {
  const double lot = uniform(random, 0.0, 1.0);
  Wanted wanted;
  wanted.kind = lot < kUpToOne         ? EverydayClass::one
                : lot < kUpToTwo       ? EverydayClass::two
                : lot < kUpToImperfect ? EverydayClass::imperfect
                                       : EverydayClass::outside;
  wanted.strong = uniform(random, 0.0, 1.0) < 0.5;
  wanted.only = draw.only;
  if (draw.only.empty()) return wanted;
  const auto& outside = everyday_outside();
  const bool is_outside = std::find(outside.begin(), outside.end(), draw.only) != outside.end();
  wanted.kind = is_outside ? EverydayClass::outside : EverydayClass::one;
  return wanted;
}

std::vector<std::string> draw_ids(const Wanted& wanted, BlindRandom& random) {
  if (wanted.kind == EverydayClass::imperfect) return {};
  if (!wanted.only.empty()) return {wanted.only};
  const auto& ids = wanted.kind == EverydayClass::outside ? everyday_outside() : everyday_effects();
  std::vector<std::string> drawn = {one_of(ids, random)};
  while (wanted.kind == EverydayClass::two && drawn.size() < 2) {
    const std::string& other = one_of(ids, random);
    if (other != drawn.front()) drawn.push_back(other);
  }
  return drawn;
}

bool are_equal(const std::vector<std::string>& ids, const BlindDesign& design) {
  if (ids.size() < 2) return false;
  const auto equal = equals_of(ids[0], design, true);
  return std::find(equal.begin(), equal.end(), ids[1]) != equal.end();
}

}  // namespace

std::string_view word(EverydayClass kind) {
  switch (kind) {
    case EverydayClass::one:
      return "one";
    case EverydayClass::two:
      return "two";
    case EverydayClass::imperfect:
      return "dirt";
    case EverydayClass::outside:
      return "outside";
  }
  return "dirt";
}

BlindDesign draw_everyday_design(BlindRandom& random) {
  constexpr std::size_t kMostEverydayFrames = 300, kFewestFrames = 20;
  BlindDesign design;
  design.k_n_s_m = log_uniform(random, 0.1, 1.6);
  design.mu = log_uniform(random, 0.002, 0.03);
  design.noise_sd_m = log_uniform(random, 5e-5, 1.5e-3);
  const int kind = one_of(random, {0, 1, 1, 1, 2, 2});
  design.groups = draw_groups(random, kind, 0.05, 0.5);
  const int masses = one_of(random, {1, 2, 2, 3});
  double mass = uniform(random, 0.2, 0.4);
  for (int m = 0; m < masses; ++m) {
    const double grams = std::round(1e3 * mass) * 1e-3;
    design.masses.push_back({grams, grams, 0.0});
    mass += uniform(random, 0.08, 0.25);
  }
  const double rate = one_of(random, {25.0, 30.0, 50.0, 60.0, 100.0, 120.0, 240.0});
  const double duration = uniform(random, 1.0, 2.5), origin = uniform(random, -0.3, 0.5);
  const std::size_t configurations = design.groups.size() * design.masses.size();
  const std::size_t most = 12 / (2 * configurations), least = configurations == 1 ? 2 : 1;
  const auto repeats = std::min(most, least + static_cast<std::size_t>(uniform(random, 0.0, 2.0)));
  const BlindLaunches launches{origin, 1.4, repeats, rate};
  for (std::size_t g = 0; g < design.groups.size(); ++g) {
    for (std::size_t m = 0; m < design.masses.size(); ++m) {
      for (std::size_t r = 0; r < 2 * repeats; ++r) {
        BlindClip clip;
        do {
          clip = draw_clip(random, design, launches, g, m, r);
          clip.frames = std::min(kMostEverydayFrames, static_cast<std::size_t>(duration * rate));
          clip.frames = frames_on_track(design, clip, origin);
        } while (clip.frames < kFewestFrames);
        design.clips.push_back(clip);
      }
    }
  }
  return design;
}

EverydayClass everyday_class(std::uint64_t seed, std::size_t index) {
  BlindRandom random = random_of(seed, index);
  return draw_wanted(random, {}).kind;
}

EverydayCase make_everyday_case(std::uint64_t seed, std::size_t index, const EverydayDraw& draw) {
  BlindRandom random = random_of(seed, index);
  const Wanted wanted = draw_wanted(random, draw);
  std::vector<std::string> ids;
  for (int attempt = 0; attempt < kMostEverydayDraws; ++attempt) {
    if (attempt % kDesignsPerCause == 0) ids = draw_ids(wanted, random);
    EverydayCase one;
    one.seed = seed;
    one.index = index;
    one.truth.kind = wanted.kind;
    one.truth.strong = wanted.strong;
    one.kind = wanted.kind == EverydayClass::one         ? BlindKind::single
               : wanted.kind == EverydayClass::two       ? BlindKind::pair
               : wanted.kind == EverydayClass::imperfect ? BlindKind::none
                                                         : BlindKind::outside;
    one.design = draw_everyday_design(random);
    const double clicks = uniform(random, 0.0, 1.0), rounds = uniform(random, 0.0, 1.0);
    one.noise = draw_noise(one.design.noise_sd_m, clicks < 0.3, rounds < 0.35, random);
    if (are_equal(ids, one.design)) continue;
    Drawn drawn;
    for (const std::string& id : ids) drawn.effects.push_back(draw_everyday_effect(id, one.design, random));
    const BlindDetection detection(one.design, draw.look);
    if (!draw_sizes(detection, wanted, random, one, drawn)) continue;
    if (!measure(detection, wanted, drawn, one.truth)) continue;
    one.x_m = filmed(one.design, drawn.everything());
    if (!is_finite(one.x_m)) continue;
    tell_truth(drawn, one);
    for (auto& clip : one.x_m) clip = with_noise(std::move(clip), one.noise, random);
    return one;
  }
  throw base::NumericalError(
      fmt::format("everyday case {} of seed {}: none of {} designs shows the effect", index, seed, kMostEverydayDraws));
}

std::string everyday_truth_json(const EverydayCase& one) {
  using Ordered = nlohmann::ordered_json;
  Ordered truth = truth_of(one);
  truth["kind"] = word(one.truth.kind);
  truth["strength"] = one.truth.strong ? "strong" : "moderate";
  truth["excess"] = one.truth.excess;
  for (std::size_t e = 0; e < one.causes.size(); ++e) {
    truth["causes"][e]["share"] = one.truth.shares[e];
    truth["causes"][e]["equals"] = one.truth.equals[e];
  }
  truth["remainder"] = one.truth.remainder;
  truth["dirt"] = Ordered::array();
  for (const ActingImperfection& imperfection : one.truth.imperfections) {
    truth["dirt"].push_back({{"id", imperfection.id},
                             {"size", imperfection.size},
                             {"unit", imperfection.unit},
                             {"excess", imperfection.excess},
                             {"fair_names", imperfection.effects}});
  }
  truth["noise"] = {{"sd_m", one.design.noise_sd_m},
                    {"white_sd_m", one.noise.white_sd_m},
                    {"clicked_sd_m", one.noise.clicked_sd_m},
                    {"clicked_frames", one.noise.clicked_frames},
                    {"rounded_m", one.noise.rounded_m}};
  truth["k_n_s_m"] = one.design.k_n_s_m;
  truth["mu"] = one.design.mu;
  truth["configurations"] = Ordered::array();
  for (const EverydayConfiguration& of : one.truth.configurations) {
    Ordered object{{"group", of.group}, {"mass_kg", of.mass_kg}, {"incline_deg", of.incline_deg}};
    for (const core::QuantityName& name : core::kQuantities) {
      const std::optional<double> value = true_value(of, name.which);
      object[std::string(name.key)] = value ? Ordered(*value) : Ordered();
    }
    truth["configurations"].push_back(std::move(object));
  }
  return base::json_text(truth) + "\n";
}

}  // namespace glidelab::validate
