#include "core/pictures/marker/marker_track.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "core/pictures/marker/marker_method.h"

namespace glidelab::core {
namespace {

constexpr std::size_t kSearchPeriod = 10;           // frames between searches of the whole image
constexpr std::size_t kLongestSearchPeriod = 80;    // the same while the marker is tracked
constexpr double kLongestSearchPeriod_s = 0.4;      // limit in time: ten frames of a slow camera
constexpr std::size_t kMostPastBytes = 1 << 27;     // of the frames that are kept to follow paths back,
constexpr std::size_t kMostPast = 120;              // and their number
constexpr std::size_t kSamplesToChooseMethod = 24;  // windows from which the method of a path is chosen
constexpr std::size_t kMostRestingFollowed = 10;    // paths at rest that are followed all the same
constexpr std::size_t kLostAfter = 25;              // frames without a sighting that end a path
constexpr std::size_t kRestFrames = 12;             // sightings after which a path that has not moved may sleep
constexpr std::size_t kMovingFrames = 10;           // sightings of a path that counts as moving after five radii
constexpr std::size_t kFewestSightings = 5;         // a path with fewer is noise
constexpr std::size_t kNoDisc = 2;                  // sightings by centroid in a row, after which no disc is fitted
constexpr std::size_t kMostLit = 6;                 // blobs of the highest contrast that may be lit from one side
constexpr double kSmallestRadiusPx = 1.2;

bool is_near_any(const std::vector<cv::Point2d>& places, cv::Point2d here, double distance) {
  return std::any_of(places.begin(), places.end(),
                     [&](cv::Point2d other) { return cv::norm(other - here) < distance; });
}

/// How the object of a path is sought in the next frame. One that was no disc twice in a row is not fitted
/// as one again: choose_method() does so once, in all samples.
MarkerMethod next_method(const MarkerPath& path) {
  if (path.method != MarkerMethod::undecided) return path.method;
  if (path.lit) return MarkerMethod::shaded;
  if (path.seen.size() < kNoDisc) return path.method;
  const bool no_disc = std::all_of(path.seen.end() - kNoDisc, path.seen.end(),
                                   [](const MarkerSeen& seen) { return !(seen.fit.blur_px > 0.0); });
  return no_disc ? MarkerMethod::centroid : path.method;
}

}  // namespace

MarkerTracker::MarkerTracker(std::filesystem::path clip, MarkerSetup marker, RadiusAt radius_at,
                             std::optional<double> start_s)
    : clip_(std::move(clip)),
      marker_(std::move(marker)),
      kind_(signal_kind(marker_)),
      radius_at_(std::move(radius_at)),
      start_s_(start_s) {}

MarkerTracker MarkerTracker::of_any_shape(std::filesystem::path clip, const MarkerSetup& marker, RadiusAt radius_at,
                                          std::optional<double> start_s, bool blurred) {
  MarkerTracker tracker(std::move(clip), marker, std::move(radius_at), start_s);
  tracker.kind_ = SignalKind::any_shape;
  if (blurred) tracker.first_method_ = MarkerMethod::centroid;
  return tracker;
}

/// The object of a path in the next frame: fitted at the expected position, or sought around it.
std::optional<MeasuredMarker> MarkerTracker::find_again(const Signal& signal, std::size_t frame, const Path& path,
                                                        const std::vector<cv::Point2d>& taken) const {
  const cv::Point2d expected = path.predict(frame);
  const bool is_new = path.seen.size() < 2;
  const MarkerMethod method = next_method(path);
  MarkerGuess guess;
  guess.centre = expected;
  guess.radius_px = path.radius_px;
  const MarkerFit& last = path.seen.back().fit;
  if (last.blur_px > 0.0) {  // a fit, not a centroid
    guess.blur_px = last.blur_px;
    guess.shape = last.shape;
  }
  if (!is_new && !is_near_any(taken, expected, 0.5 * path.radius_px)) {
    const auto fit = measure_marker(signal, guess, method, kind_);
    if (fit && path.is_like(*fit)) return MeasuredMarker{guess, *fit};
  }
  // Nothing is known of the speed of a new path. A known speed changes little from frame to frame, but the object may
  // bounce.
  const double lost = std::abs(frames_between(path.seen.back().frame, frame)) - 1.0;
  const double speed = cv::norm(path.velocity());
  const double gate = is_new ? (6.0 + lost) * path.radius_px + 10.0
                             : (2.0 + 0.1 * lost) * path.radius_px + (1.5 + 0.1 * lost) * speed + 2.0;
  const int half = static_cast<int>(std::ceil(gate));
  BlobSearch search;
  search.radius_px = path.radius_px;
  search.bright_neighbours = 3;
  search.least_contrast = least_contrast(kind_);
  search.most = 6;
  search.region = cv::Rect(static_cast<int>(std::lround(expected.x)) - half,
                           static_cast<int>(std::lround(expected.y)) - half, 2 * half + 1, 2 * half + 1);
  std::vector<Blob> blobs = find_blobs(signal, search);
  std::stable_sort(blobs.begin(), blobs.end(), [&](const Blob& a, const Blob& b) {
    return cv::norm(a.centre - expected) < cv::norm(b.centre - expected);
  });
  for (const Blob& blob : blobs) {
    if (is_near_any(taken, blob.centre, 0.7 * path.radius_px)) continue;
    guess.centre = blob.centre + path.from_blob;
    const auto found = measure_near(signal, guess, method, kind_);
    if (!found || !path.is_like(found->fit)) continue;
    if (is_near_any(taken, found->fit.centre, 0.7 * path.radius_px)) continue;
    return found;
  }
  return std::nullopt;
}

/// Keeps the window of a fit; a centroid, and a marker that is told by its hue or its light, are not fitted again.
void MarkerTracker::keep(const Signal& signal, std::size_t frame, const MeasuredMarker& found) {
  const bool is_centroid = !(found.fit.blur_px > 0.0);
  if (is_centroid || may_have_any_shape(kind_)) return;
  windows_.keep(signal, frame, found.guess, found.fit);
}

void MarkerTracker::accept(Path& path, const Signal& signal, std::size_t frame, const MeasuredMarker& found) {
  path.push({frame, found.fit, radius_at_(found.fit.centre)});
  keep(signal, frame, found);
  if (path.method != MarkerMethod::undecided) return;
  const int reach = static_cast<int>(std::ceil(2.2 * found.guess.radius_px + 6.0));
  const cv::Rect box =
      cv::Rect(static_cast<int>(std::lround(found.fit.centre.x)) - reach,
               static_cast<int>(std::lround(found.fit.centre.y)) - reach, 2 * reach + 1, 2 * reach + 1) &
      cv::Rect(0, 0, signal.values.cols, signal.values.rows);
  signal.see(box);
  MarkerGuess guess = found.guess;
  guess.centre = found.fit.centre - cv::Point2d(box.x, box.y);
  path.samples.push_back({frame, Signal{signal.values(box).clone()}, box.tl(), guess});
  if (path.samples.size() >= kSamplesToChooseMethod) decide(path);
}

std::vector<cv::Point2d> MarkerTracker::places_at(std::size_t frame) const {
  std::vector<cv::Point2d> places;
  for (const Path& path : paths_) {
    const auto at = std::lower_bound(path.seen.begin(), path.seen.end(), frame,
                                     [](const MarkerSeen& seen, std::size_t wanted) { return seen.frame < wanted; });
    if (at != path.seen.end() && at->frame == frame) places.push_back(at->fit.centre);
  }
  return places;
}

void MarkerTracker::follow(const Signal& signal, std::size_t frame) {
  std::vector<Path*> order;
  for (Path& path : paths_) {
    if (!path.ended && !path.asleep) order.push_back(&path);
  }
  // Moving paths that are not lost have the first claim, then those that have been seen longest. A lost path may not
  // take the object of another.
  const auto is_lost = [&](const Path* path) { return path->seen.back().frame + 1 < frame; };
  const auto claim = [&](const Path* path) {
    return is_lost(path) ? 2 : path->travel_px > least_travel(path->radius_px) ? 0 : 1;
  };
  std::stable_sort(order.begin(), order.end(), [&](const Path* a, const Path* b) {
    return claim(a) != claim(b) ? claim(a) < claim(b) : a->seen.size() > b->seen.size();
  });
  std::vector<cv::Point2d> taken;
  std::vector<cv::Point2d> sleeping;
  for (const Path& path : paths_) {
    if (path.asleep) sleeping.push_back(path.seen.back().fit.centre);
  }
  for (Path* path : order) {
    std::vector<cv::Point2d> not_here = taken;
    // A new or a lost path does not jump to an object at rest. One with a known speed may pass in front of it.
    if (path->seen.size() < 3 || is_lost(path)) not_here.insert(not_here.end(), sleeping.begin(), sleeping.end());
    const auto found = find_again(signal, frame, *path, not_here);
    if (!found) continue;
    taken.push_back(found->fit.centre);
    accept(*path, signal, frame, *found);
  }
}

/// Follows a path back through the frames that are kept, down to `from_frame`, until it is lost.
void MarkerTracker::follow_back(Path& path, std::size_t from_frame) {
  Path back;
  back.method = path.method;
  back.lit = path.lit;
  back.from_blob = path.from_blob;
  for (auto seen = path.seen.rbegin(); seen != path.seen.rend(); ++seen) back.push(*seen);
  const std::size_t before = path.seen.front().frame;
  std::size_t missed = 0;
  for (auto past = past_.rbegin(); past != past_.rend() && missed < 3; ++past) {
    if (past->frame >= before || past->frame < from_frame) continue;
    const auto found = find_again(past->signal, past->frame, back, places_at(past->frame));
    if (found) {
      back.push({past->frame, found->fit, radius_at_(found->fit.centre)});
      keep(past->signal, past->frame, *found);
      missed = 0;
    } else {
      ++missed;
    }
  }
  path.seen.clear();
  path.travel_px = 0.0;
  for (auto seen = back.seen.rbegin(); seen != back.seen.rend(); ++seen) path.push(*seen);
}

/// Chooses the method of a path, and follows it back by that method.
void MarkerTracker::decide(Path& path) {
  const std::size_t sampled = path.samples.empty() ? path.seen.front().frame : path.samples.front().frame;
  choose_method(path, kind_, radius_at_);
  // What was measured as a uniform disc while following back is measured again, if all of its frames are still there.
  std::vector<MarkerSeen> before;
  const bool again = path.method != MarkerMethod::uniform && !past_.empty() &&
                     path.seen.front().frame >= past_.front().frame && path.seen.size() >= 2 &&
                     path.seen[path.seen.size() - 2].frame >= sampled;
  if (again) {
    const auto first = std::ranges::find_if(path.seen, [&](const MarkerSeen& seen) { return seen.frame >= sampled; });
    before.assign(path.seen.begin(), first);
    path.seen.erase(path.seen.begin(), first);
  }
  follow_back(path, 0);
  // Where the new method finds nothing any more, the first measurement stays.
  std::erase_if(before, [&](const MarkerSeen& seen) { return seen.frame >= path.seen.front().frame; });
  if (before.empty()) return;
  before.insert(before.end(), path.seen.begin(), path.seen.end());
  path.seen.clear();
  path.travel_px = 0.0;
  for (const MarkerSeen& seen : before) path.push(seen);
}

/// The brightest path of the right size that is seen moving in this frame; null if there is none.
const MarkerTracker::Path* MarkerTracker::mover(std::size_t frame) const {
  const Path* best = nullptr;
  for (const Path& path : paths_) {
    if (path.ended || path.asleep || path.seen.back().frame != frame || path.seen.size() < kMovingFrames) continue;
    if (path.travel_px < 5.0 * path.radius_px || std::abs(std::log(path.size_ratio())) > 0.3) continue;
    if (best == nullptr || path.amplitude > best->amplitude) best = &path;
  }
  return best;
}

void MarkerTracker::search_whole(const Signal& signal, std::size_t frame) {
  BlobSearch search;
  search.radius_px = radius_px_;
  search.least_contrast = least_contrast(kind_);
  // Once something moves, only a blob of similar brightness can be another piece of it, or a second marker.
  if (const Path* moving = mover(frame))
    search.least_contrast = std::max(search.least_contrast, 0.3 * moving->amplitude);
  search.region = cv::Rect(0, 0, signal.values.cols, signal.values.rows);
  std::vector<cv::Point2d> known = places_at(frame);
  std::vector<cv::Point2d> sleeping;
  for (const Path& path : paths_) {
    if (path.asleep) sleeping.push_back(path.seen.back().fit.centre);
  }
  std::size_t searched_for_lit = 0;
  for (const Blob& blob : find_blobs(signal, search)) {
    MarkerGuess guess;
    guess.centre = blob.centre;
    guess.radius_px = std::max(radius_at_(blob.centre), kSmallestRadiusPx);
    if (is_near_any(known, blob.centre, 0.7 * guess.radius_px) ||
        is_near_any(sleeping, blob.centre, 0.7 * guess.radius_px)) {
      continue;
    }
    auto found = measure_near(signal, guess, first_method_, kind_);
    const bool lit = !found && ++searched_for_lit <= kMostLit;
    if (lit) found = measure_lit(signal, guess, kind_);
    if (!found || found->fit.elongation > kLargestElongation ||
        is_near_any(known, found->fit.centre, 0.7 * guess.radius_px))
      continue;
    const MarkerFit& fit = found->fit;
    known.push_back(fit.centre);
    // A path that has just lost its object takes over a blob near the expected position.
    const auto loser = std::find_if(paths_.begin(), paths_.end(), [&](const Path& path) {
      return !path.ended && !path.asleep && path.seen.back().frame < frame && path.seen.size() >= kFewestSightings &&
             path.is_like(fit) &&
             cv::norm(path.predict(frame) - fit.centre) < 4.0 * path.radius_px + 2.0 * cv::norm(path.velocity());
    });
    if (loser != paths_.end()) {
      accept(*loser, signal, frame, *found);
      continue;
    }
    Path path;
    path.method = first_method_;
    path.lit = lit;
    if (lit) path.from_blob = fit.centre - blob.centre;
    accept(path, signal, frame, *found);
    follow_back(path, searched_);
    paths_.push_back(std::move(path));
  }
}

/// Objects at rest are not all followed in every frame: none once something of the right size moves, otherwise those
/// most like a marker.
void MarkerTracker::put_to_sleep(std::size_t frame) {
  std::vector<Path*> resting;
  const bool something_moves = mover(frame) != nullptr;
  for (Path& path : paths_) {
    if (path.ended || path.asleep || path.seen.size() < kRestFrames) continue;
    if (path.travel_px < 0.5 * least_travel(path.radius_px)) {
      resting.push_back(&path);
    }
  }
  const auto rank = [&](const Path* path) {
    return std::abs(std::log(path->size_ratio())) - 0.2 * std::log(path->amplitude);
  };
  std::stable_sort(resting.begin(), resting.end(), [&](const Path* a, const Path* b) { return rank(a) < rank(b); });
  for (std::size_t i = something_moves ? 0 : kMostRestingFollowed; i < resting.size(); ++i) resting[i]->asleep = true;
}

void MarkerTracker::tidy(std::size_t frame) {
  for (Path& path : paths_) {
    const auto lost = static_cast<std::size_t>(frames_between(path.seen.back().frame, frame));
    if (!path.asleep && lost > (path.seen.size() < kFewestSightings ? 3 : kLostAfter)) path.ended = true;
  }
  std::erase_if(paths_, [](const Path& path) { return path.ended && path.seen.size() < kFewestSightings; });
  if (windows_.should_free()) windows_.free_all_but(paths_);
}

/// A piece of the marker or a second marker that is found late is followed back through the kept frames. Only an object
/// that comes and goes between two searches is missed.
bool MarkerTracker::is_time_to_search(const Signal& signal, const Frame& frame) const {
  if (frame.index % kSearchPeriod != 0) return false;
  const bool any_lost = std::any_of(paths_.begin(), paths_.end(), [&](const Path& path) {
    return !path.ended && !path.asleep && path.seen.back().frame < frame.index && path.seen.size() >= kFewestSightings;
  });
  if (any_lost || mover(frame.index) == nullptr) return true;
  const std::size_t bytes = std::max<std::size_t>(signal.values.total() * signal.values.elemSize(), 1);
  const std::size_t period = std::clamp(kMostPastBytes / bytes, kSearchPeriod, kLongestSearchPeriod);
  const double since = frames_between(searched_, frame.index), until_next = since + kSearchPeriod;
  const double until_next_s = (frame.t_s - searched_s_) * until_next / since;
  return until_next > static_cast<double>(period) || until_next_s > kLongestSearchPeriod_s + 1e-9;
}

/// Searches for what came since the last search, if that was long ago.
void MarkerTracker::search_rest() {
  if (frames_ <= searched_ + kSearchPeriod) return;
  const Past last = past_.back();
  search_whole(last.signal, last.frame);
}

void MarkerTracker::add(const Frame& frame) {
  const auto signal = signal_of(frame, marker_, kind_);
  if (!signal)
    throw base::InputError(base::Issue{clip_.string(), 0, "marker", "a clip without colours",
                                       "a clip in colour, as [marker] color asks for"});
  if (frames_ == 0) {
    const cv::Point2d middle(0.5 * (signal->values.cols - 1), 0.5 * (signal->values.rows - 1));
    radius_px_ = std::max(radius_at_(middle), kSmallestRadiusPx);
  }
  if (const double off = start_s_ ? std::abs(frame.t_s - *start_s_) : 0.0; off < from_start_s_) {
    start_frame_ = frame.index;
    from_start_s_ = off;
  }
  follow(*signal, frame.index);
  if (is_time_to_search(*signal, frame)) {
    search_whole(*signal, frame.index);
    searched_ = frame.index;
    searched_s_ = frame.t_s;
  }
  if (frame.index % kSearchPeriod == 0) {
    put_to_sleep(frame.index);
    tidy(frame.index);
  }
  past_.push_back({frame.index, *signal});
  const std::size_t bytes = std::max<std::size_t>(signal->values.total() * signal->values.elemSize(), 1);
  if (past_.size() > std::clamp(kMostPastBytes / bytes, kSearchPeriod, kMostPast)) past_.pop_front();
  frames_ = frame.index + 1;
}

TrackedMarker MarkerTracker::finish() {
  search_rest();
  for (Path& path : paths_) {
    if (path.method == MarkerMethod::undecided) decide(path);
  }
  TrackedMarker tracked =
      choose_marker({joined_pieces(std::move(paths_)), frames_, radius_px_, start_frame_}, marker_, clip_);
  correct_for_pixels(tracked, windows_, kind_ == SignalKind::bright || kind_ == SignalKind::dark);
  return tracked;
}

}  // namespace glidelab::core
