#include "render/video/video_format.h"

#include <stdexcept>

namespace glidelab::render {

const char* name_of(Codec codec) {
  switch (codec) {
    case Codec::ffv1:
      return "ffv1";
    case Codec::raw:
      return "raw";
    case Codec::png:
      return "png";
    case Codec::mjpeg:
      return "mjpeg";
    case Codec::h264:
      return "h264";
  }
  throw std::logic_error("unknown codec");
}

Container usual_container(Codec codec) {
  switch (codec) {
    case Codec::ffv1:
      return Container::mkv;
    case Codec::raw:
    case Codec::mjpeg:
      return Container::avi;
    case Codec::h264:
      return Container::mp4;
    case Codec::png:
      return Container::folder;
  }
  throw std::logic_error("unknown codec");
}

bool fits(Codec codec, Container container) {
  return container == usual_container(codec) ||
         (container == Container::mkv && codec != Codec::png && codec != Codec::raw) ||
         (container == Container::mp4 && codec == Codec::mjpeg);
}

std::string file_name_of(Codec codec, const Compression& compression, const std::string& clip) {
  const Container container = compression.container.value_or(usual_container(codec));
  if (!fits(codec, container)) throw std::logic_error("a container that does not fit the codec");
  switch (container) {
    case Container::mkv:
      return clip + ".mkv";
    case Container::avi:
      return clip + ".avi";
    case Container::mp4:
      return clip + ".mp4";
    case Container::folder:
      return clip;
  }
  throw std::logic_error("unknown container");
}

std::string file_name_of(Codec codec, const std::string& clip) {
  return file_name_of(codec, Compression{}, clip);
}

}  // namespace glidelab::render
