#include "diagnose/result/image_fact.h"

namespace glidelab::diagnose {

ImageFact::ImageFact() = default;
ImageFact::ImageFact(const ImageFact&) = default;
ImageFact::ImageFact(ImageFact&&) noexcept = default;
ImageFact& ImageFact::operator=(const ImageFact&) = default;
ImageFact& ImageFact::operator=(ImageFact&&) noexcept = default;
ImageFact::~ImageFact() = default;

}  // namespace glidelab::diagnose
