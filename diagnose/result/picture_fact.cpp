#include "diagnose/result/picture_fact.h"

namespace glidelab::diagnose {

PictureFact::PictureFact() = default;
PictureFact::PictureFact(const PictureFact&) = default;
PictureFact::PictureFact(PictureFact&&) noexcept = default;
PictureFact& PictureFact::operator=(const PictureFact&) = default;
PictureFact& PictureFact::operator=(PictureFact&&) noexcept = default;
PictureFact::~PictureFact() = default;

}  // namespace glidelab::diagnose
