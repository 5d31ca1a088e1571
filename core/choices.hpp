#pragma once

#include <optional>

namespace fluxel {

enum class KeMeaning { exitance, radiance };
/// What has the mean of a texture: a material over all its faces, or each large face that differs from it.
enum class Textures { mean, face };
enum class Method { matrix, hierarchical, paths, view, photons };
/// What decides how fine a link has to be, beside the geometry of the pair.
enum class Oracle { all, power, importance, geometry };
/// How nodes of the hierarchical method exchange light: by links between them or by rays from each;
/// automatic: by rays in pictures of scenes of many faces.
enum class ExchangeBy { automatic, links, rays };
/// What a target error is of: the picture or the surfaces over the mean of all, or also the mean of each of
/// their regions over its own.
enum class ErrorOf { picture, surfaces, regions };
/// Where the pixels of a hierarchical run's picture have their light from: leaves, a gather at each, or what
/// is emitted gathered at each and what is reflected at few.
enum class PictureFrom { elements, gather, cached };
/// How luminance is shown: in proportion, or by a curve that compresses what is bright.
enum class Tone { linear, filmic, reinhard };
enum class Subdivision { camera, uniform, none, transport };
enum class Subscenes { merged, independent };
enum class FormFactor { point, disc, points, adaptive };
enum class Solver { automatic, jacobi, gauss_seidel, conjugate_gradients, southwell };
enum class Isa { automatic, sse4, avx2, avx512 };
/// What becomes of surfaces that do more than reflect evenly: refused by methods that do not know them, taken
/// as black but for what they reflect evenly, or followed.
enum class Specular { refuse, absorb, follow };
/// What makes visibility, applies the matrix and follows paths of light; automatic: a GPU where the rank has
/// one that can.
enum class Device { cpu, cuda, automatic };

/// How a reference's samples are dealt: as many to every sensor, or more to blocks of sensors that vary more.
enum class Sampling { even, blocks };

/// What a reference measures.
enum class Measured { all, elements, picture, receivers };

/// The points by which photons go.
enum class Sequence { sobol, halton, scrambled, random };

/// Sample points on an element, m along its first edge and n across, of FormFactor::points.
struct PointGrid {
  int m = 2;
  int n = 2;

  bool operator==(const PointGrid&) const = default;
};

/// What values the colours of false-colour pictures mean, as Radiance's falsecolor has it (-s, -log).
struct FalseColourScale {
  std::optional<double> max;      ///< unset: of each picture its own
  std::optional<double> decades;  ///< logarithmic, from so many below max; unset: linear, from 0
};

/// How the exchange of a pair is found, and how well.
struct FormFactorOptions {
  FormFactor rule = FormFactor::adaptive;
  PointGrid points;
  double tolerance = 1e-3;  ///< of adaptive: about the largest error of a row's sum
  bool partial_visibility = true;
  bool closure = false;

  bool operator==(const FormFactorOptions&) const = default;
};

}  // namespace fluxel
