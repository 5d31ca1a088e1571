#pragma once

#include <algorithm>
#include <map>
#include <string>

#include "core/choices.hpp"
#include "core/material.hpp"

namespace fluxel {

// What the command line and reports call the choices of an option.

inline const std::map<std::string, Sides> kSidesNames{{"one", Sides::one}, {"two", Sides::two}};
inline const std::map<std::string, KeMeaning> kKeNames{{"exitance", KeMeaning::exitance},
                                                       {"radiance", KeMeaning::radiance}};
inline const std::map<std::string, Textures> kTexturesNames{{"face", Textures::face},
                                                            {"mean", Textures::mean}};
inline const std::map<std::string, Subdivision> kSubdivisionNames{{"camera", Subdivision::camera},
                                                                  {"none", Subdivision::none},
                                                                  {"transport", Subdivision::transport},
                                                                  {"uniform", Subdivision::uniform}};
inline const std::map<std::string, FormFactor> kRuleNames{
    {"adaptive", FormFactor::adaptive}, {"disc", FormFactor::disc}, {"point", FormFactor::point}};
inline const std::map<std::string, Oracle> kOracleNames{{"all", Oracle::all},
                                                        {"geometry", Oracle::geometry},
                                                        {"importance", Oracle::importance},
                                                        {"power", Oracle::power}};
inline const std::map<std::string, ExchangeBy> kExchangeNames{
    {"auto", ExchangeBy::automatic}, {"links", ExchangeBy::links}, {"rays", ExchangeBy::rays}};
inline const std::map<std::string, PictureFrom> kPictureNames{
    {"cached", PictureFrom::cached}, {"elements", PictureFrom::elements}, {"gather", PictureFrom::gather}};
inline const std::map<std::string, Tone> kToneNames{
    {"filmic", Tone::filmic}, {"linear", Tone::linear}, {"reinhard", Tone::reinhard}};
inline const std::map<std::string, ErrorOf> kErrorOfNames{
    {"picture", ErrorOf::picture}, {"regions", ErrorOf::regions}, {"surfaces", ErrorOf::surfaces}};
inline const std::map<std::string, Subscenes> kSubscenesNames{{"merged", Subscenes::merged},
                                                              {"independent", Subscenes::independent}};
inline const std::map<std::string, Solver> kSolverNames{{"auto", Solver::automatic},
                                                        {"cg", Solver::conjugate_gradients},
                                                        {"gauss-seidel", Solver::gauss_seidel},
                                                        {"jacobi", Solver::jacobi},
                                                        {"southwell", Solver::southwell}};
inline const std::map<std::string, Measured> kMeasuredNames{
    {"elements", Measured::elements}, {"picture", Measured::picture}, {"receivers", Measured::receivers}};
inline const std::map<std::string, Measured> kCountedNames{{"elements", Measured::elements},
                                                           {"receivers", Measured::receivers}};
inline const std::map<std::string, Sampling> kSamplingNames{{"blocks", Sampling::blocks},
                                                            {"even", Sampling::even}};
inline const std::map<std::string, Sequence> kSequenceNames{{"halton", Sequence::halton},
                                                            {"random", Sequence::random},
                                                            {"scrambled", Sequence::scrambled},
                                                            {"sobol", Sequence::sobol}};
inline const std::map<std::string, Specular> kSpecularNames{{"absorb", Specular::absorb},
                                                            {"refuse", Specular::refuse}};
/// Of methods that know all surfaces.
inline const std::map<std::string, Specular> kFollowNames{{"absorb", Specular::absorb},
                                                          {"follow", Specular::follow}};
inline const std::map<std::string, Device> kDeviceNames{
    {"auto", Device::automatic}, {"cpu", Device::cpu}, {"cuda", Device::cuda}};
inline const std::map<std::string, Isa> kIsaNames{
    {"auto", Isa::automatic}, {"avx2", Isa::avx2}, {"avx512", Isa::avx512}, {"sse4", Isa::sse4}};

/// The name of a value.
template <class Value>
std::string name_of(const std::map<std::string, Value>& names, Value value) {
  return std::ranges::find_if(names, [value](const auto& entry) { return entry.second == value; })->first;
}

}  // namespace fluxel
