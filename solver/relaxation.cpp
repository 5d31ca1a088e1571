#include "solver/iteration.hpp"

namespace fluxel {

namespace {

/// Jacobi's and Gauss-Seidel's methods keep the last two radiosities; the difference is the change.
template <class Value>
class Relaxation : public Iteration<Value> {
 public:
  Relaxation(const LinearSystem<Value>& system, std::span<const Value> start)
      : system_(system), B_(start.begin(), start.end()), change_(B_.size()) {}

  void advance() final {
    change_ = B_;
    relax(B_);
    for (std::size_t i = 0; i < B_.size(); ++i) change_[i] = B_[i] - change_[i];
  }

  [[nodiscard]] std::span<const Value> radiosity() const final { return B_; }
  [[nodiscard]] std::span<const Value> change() const final { return change_; }
  [[nodiscard]] ChangeKind change_kind() const final { return ChangeKind::step; }

 protected:
  virtual void relax(std::vector<Value>& B) = 0;
  const LinearSystem<Value>& system_;

 private:
  std::vector<Value> B_, change_;
};

template <class Value>
class Jacobi final : public Relaxation<Value> {
 public:
  using Relaxation<Value>::Relaxation;

 private:
  void relax(std::vector<Value>& B) override {
    H_.resize(B.size());
    this->system_.F.apply(std::span<const Value>(B), std::span<Value>(H_));
    for (std::size_t i = 0; i < B.size(); ++i) B[i] = this->system_.E[i] + this->system_.rho[i] * H_[i];
  }

  std::vector<Value> H_;
};

template <class Value>
class GaussSeidel final : public Relaxation<Value> {
 public:
  using Relaxation<Value>::Relaxation;

 private:
  void relax(std::vector<Value>& B) override {
    const LinearSystem<Value>& system = this->system_;
    system.F.sweep(std::span<const Value>(system.E), std::span<const Value>(system.rho), std::span<Value>(B));
  }
};

}  // namespace

template <class Value>
std::unique_ptr<Iteration<Value>> make_jacobi(const LinearSystem<Value>& system,
                                              std::span<const Value> start) {
  return std::make_unique<Jacobi<Value>>(system, start);
}

template <class Value>
std::unique_ptr<Iteration<Value>> make_gauss_seidel(const LinearSystem<Value>& system,
                                                    std::span<const Value> start) {
  return std::make_unique<GaussSeidel<Value>>(system, start);
}

template std::unique_ptr<Iteration<double>> make_jacobi(const LinearSystem<double>&, std::span<const double>);
template std::unique_ptr<Iteration<Rgb>> make_jacobi(const LinearSystem<Rgb>&, std::span<const Rgb>);
template std::unique_ptr<Iteration<double>> make_gauss_seidel(const LinearSystem<double>&,
                                                              std::span<const double>);
template std::unique_ptr<Iteration<Rgb>> make_gauss_seidel(const LinearSystem<Rgb>&, std::span<const Rgb>);

}  // namespace fluxel
