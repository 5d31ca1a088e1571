#pragma once

namespace fluxel {

/// What ends a job of photons.
enum class PhotonEnding {
  target,    ///< the errors that were asked for
  photons,   ///< as many as were asked for, or as there are points
  received,  ///< as many have come to where they were asked for
  vain,      ///< of many photons none has come to where the error was asked for
  time,
  signal,
  renewed  ///< all photons of an earlier scene have gone again
};

}  // namespace fluxel
