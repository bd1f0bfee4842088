#include "diagnose/next/next_words.h"

#include <map>

namespace glidelab::diagnose {
std::string next_for_pictures(std::string_view id) {
  static const std::map<std::string_view, const char*> kSentences = {
      {"dropped_frames",
       "Record the same launch again at half the frame rate or with a smaller picture, and keep the camera's own time "
       "stamps: frames are lost where writing them does not keep up, and a time stamp shows the gap, which no other "
       "launch does."},
      {"timestamp_jitter",
       "Record the same launch again with the camera's own time stamps, or with a lamp in the picture that counts "
       "milliseconds: an uneven time moves a position by the speed times its error, and only a clock shows the error "
       "itself."},
      {"rolling_shutter",
       "Turn the camera upside down and record the same launch again (or film it with a global shutter): rows are read "
       "in the other order over the track then, so that their lateness and the marker's shear change sign, and a force "
       "does not."},
      {"exposure_blur",
       "Record the same launch again with half the exposure and twice the light: the marker's smear is the speed times "
       "the exposure, and halves if the exposure is what makes it."},
      {"light_flicker",
       "Record the same launch again with an exposure of one whole period of the flicker (lamps flicker at twice the "
       "mains' frequency: 10 ms at 50 Hz, 8.3 ms at 60 Hz), or in light of a direct current: every frame collects the "
       "same light then."},
      {"light_gradient",
       "Record the same launch again with a second lamp from the other side, or through a diffuser: where the light is "
       "even, nothing pulls the marker's centre to the brighter side."},
      {"compression",
       "Record the same launch again without loss (FFV1 or single images; at least MJPEG in place of H.264): edges of "
       "blocks and errors that last over frames come from the codec and go with it."},
      {"camera_motion",
       "Put the camera on a stand that does not touch the table, with a mark that is fixed to the wall in the picture, "
       "and record the same launch again: a camera that sways moves the mark as it moves the glider."},
      {"heavy_tailed_noise",
       "Record the same launch again with a larger marker of more contrast and nothing else that is round in the "
       "picture: single positions far off are frames in which something else was taken for part of it."},
  };
  const auto found = kSentences.find(id);
  return found == kSentences.end() ? std::string() : found->second;
}

}  // namespace glidelab::diagnose
