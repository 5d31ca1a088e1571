#include "solver/iteration.hpp"

namespace fluxel {

namespace {

template <class Value>
Value ratio(const Value& numerator, const Value& denominator) {
  return by_channel([](double n, double d) { return d > 0 ? n / d : 0; }, numerator, denominator);
}

template <class Value>
class ConjugateGradients final : public Iteration<Value> {
 public:
  ConjugateGradients(const LinearSystem<Value>& system, std::span<const Value> start)
      : system_(system),
        R_(system.size()),
        S_(system.size()),
        u_(system.size()),
        residual_(system.size()),
        direction_(system.size()),
        sent_(system.size()),
        product_(system.size()),
        B_(start.begin(), start.end()),
        change_(system.size()) {
    for (std::size_t i = 0; i < R_.size(); ++i) {
      const double A = system_.area[i];
      if (!(A > 0)) continue;
      R_[i] = glm::sqrt(system_.rho[i] / A);
      S_[i] = glm::sqrt(system_.rho[i] * A);
    }
  }

  void advance() override {
    if (first_) {
      apply_to(B_);
      system_.residual_of(B_, product_, change_);
      start_from(B_, change_);
      first_ = false;
    }
    for (std::size_t i = 0; i < sent_.size(); ++i) sent_[i] = R_[i] * direction_[i];
    apply_to(sent_);
    for (std::size_t i = 0; i < product_.size(); ++i) product_[i] = direction_[i] - S_[i] * product_[i];
    const Value curvature = product_of(direction_, product_);
    note_breakdown(curvature);
    const Value along = ratio(squared_, curvature);
    for (std::size_t i = 0; i < u_.size(); ++i) {
      u_[i] += along * direction_[i];
      residual_[i] -= along * product_[i];
      B_[i] = system_.E[i] + R_[i] * u_[i];
      change_[i] = R_[i] * residual_[i];
    }
    const Value squared = product_of(residual_, residual_);
    const Value kept = ratio(squared, squared_);
    for (std::size_t i = 0; i < direction_.size(); ++i)
      direction_[i] = going_on_ * (residual_[i] + kept * direction_[i]);
    squared_ = squared;
  }

  [[nodiscard]] std::span<const Value> radiosity() const override { return B_; }
  [[nodiscard]] std::span<const Value> change() const override { return change_; }
  [[nodiscard]] ChangeKind change_kind() const override { return ChangeKind::residual; }
  [[nodiscard]] bool change_is_exact() const override { return false; }
  [[nodiscard]] bool broken_down() const override { return broken_down_; }

  void hold(int channel) override {
    if constexpr (kChannelsOf<Value> == 1) {
      going_on_ = 0;
    } else {
      going_on_[channel] = 0;
    }
    for (Value& along : direction_) along *= going_on_;
  }

  void restart(std::span<const Value> B, std::span<const Value> residual) override {
    start_from(B, residual);
  }

 private:
  void apply_to(const std::vector<Value>& x) {
    system_.F.apply(std::span<const Value>(x), std::span<Value>(product_));
  }

  [[nodiscard]] Value product_of(const std::vector<Value>& x, const std::vector<Value>& y) const {
    return dot<Value>(system_.F.ranks(), x, y);
  }

  /// From B, whose residual is `residual` = R times that of u.
  void start_from(std::span<const Value> B, std::span<const Value> residual) {
    for (std::size_t i = 0; i < u_.size(); ++i) {
      u_[i] = ratio(B[i] - system_.E[i], R_[i]);
      residual_[i] = ratio(residual[i], R_[i]);
    }
    going_on_ = Value(1);
    direction_ = residual_;
    squared_ = product_of(residual_, residual_);
  }

  void note_breakdown(const Value& curvature) {
    for (int c = 0; c < kChannelsOf<Value>; ++c)
      broken_down_ = broken_down_ || (channel(squared_ * going_on_, c) > 0 && !(channel(curvature, c) > 0));
  }

  const LinearSystem<Value>& system_;
  std::vector<Value> R_, S_;
  std::vector<Value> u_, residual_, direction_, sent_, product_;
  std::vector<Value> B_, change_;
  Value squared_{0};   // of the residual
  Value going_on_{1};  // 0 for channels on hold
  bool first_ = true;
  bool broken_down_ = false;
};

}  // namespace

template <class Value>
std::unique_ptr<Iteration<Value>> make_conjugate_gradients(const LinearSystem<Value>& system,
                                                           std::span<const Value> start) {
  return std::make_unique<ConjugateGradients<Value>>(system, start);
}

template std::unique_ptr<Iteration<double>> make_conjugate_gradients(const LinearSystem<double>&,
                                                                     std::span<const double>);
template std::unique_ptr<Iteration<Rgb>> make_conjugate_gradients(const LinearSystem<Rgb>&,
                                                                  std::span<const Rgb>);

}  // namespace fluxel
