// What scripts/tidy --self-test wants found: each line that says `finds CHECK` has that defect.
// clang-format off
#include <stdio.h>  // finds modernize-deprecated-headers

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/defects.hpp"
#include <string>  // finds readability-duplicate-include

using std::swap;  // finds misc-unused-using-decls

namespace fluxel {

int count_of(int amount) { return amount; }
int count_of(int number);  // finds readability-redundant-declaration

typedef int Whole;                    // finds modernize-use-using
double half(void) { return 1 / 2; }   // finds modernize-redundant-void-arg, bugprone-integer-division
int __reserved = 0;                   // finds bugprone-reserved-identifier
const int whole_of(double x) {        // finds readability-const-return-type
  return static_cast<int>(x + 0.5);   // finds bugprone-incorrect-roundings
}

std::size_t moved(std::string text) {
  const std::string taken = std::move(text);
  return taken.size() + text.size();  // finds bugprone-use-after-move
}

std::size_t by_value(std::vector<double> values) {  // finds performance-unnecessary-value-param
  return values.size();
}

std::size_t copied(const std::vector<std::string>& names) {
  const std::string first = names.front();  // finds performance-unnecessary-copy-initialization
  std::size_t sum = first.size();
  for (const std::string name : names) {  // finds performance-for-range-copy
    sum += name.find("a");                // finds performance-faster-string-find
  }
  return sum;
}

std::vector<int> grown(int count) {
  std::vector<int> values;
  for (int k = 0; k < count; ++k) {
    values.push_back(k);  // finds performance-inefficient-vector-operation
  }
  return values;
}

std::string joined(const std::string& a, const std::string& b) {
  std::string sum;
  for (int k = 0; k < 3; ++k) {
    sum = sum + a + b;  // finds performance-inefficient-string-concatenation
  }
  return sum;
}

bool found(const std::set<int>& numbers) {
  return std::find(numbers.begin(), numbers.end(), 3) != numbers.end();  // finds performance-inefficient-algorithm
}

float rooted(float x) { return static_cast<float>(::sqrt(x)); }  // finds performance-type-promotion-in-math-fn

int* nothing() { return 0; }  // finds modernize-use-nullptr

void emplaced(std::vector<std::pair<int, int>>& pairs) {
  pairs.push_back(std::make_pair(1, 2));                        // finds modernize-use-emplace
  const std::unique_ptr<int> one = std::unique_ptr<int>(new int(1));  // finds modernize-make-unique
  const std::shared_ptr<int> two = std::shared_ptr<int>(new int(2));  // finds modernize-make-shared
  pairs.emplace_back(*one, *two);
  std::remove(pairs.begin(), pairs.end(), pairs.front());  // finds bugprone-unused-return-value
}

double total(const std::vector<double>& values) {
  double sum = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {  // finds modernize-loop-convert
    sum += values[k];
  }
  return sum;
}

class Base {
 public:
  Base() {}  // finds modernize-use-equals-default
  virtual ~Base() = default;
  virtual int size() const { return 1; }
  virtual int depth() const { return 1; }
  int field = 0;
};

class Middle : public Base {
 public:
  int depth() const override { return Base::depth() + 1; }
};

class Derived : public Middle {
 public:
  Derived() = default;
  Derived(const Derived& other) : Middle(), number_(other.number_) {}  // finds bugprone-copy-constructor-init
  Derived(Derived&& other) : Middle(other), number_(other.number_) {}  // finds performance-noexcept-move-constructor
  virtual int size() const { return number_; }                         // finds modernize-use-override
  int depth() const override { return Base::depth(); }                 // finds bugprone-parent-virtual-call
  int tell() { return number_; }                     // finds readability-make-member-function-const

 private:
  int number_ = 0;
};

class Uncopied {
 public:
  Uncopied() = default;

 private:
  Uncopied(const Uncopied&);  // finds modernize-use-equals-delete
};

int thrown(int x) {
  if (x < 0) {
    std::runtime_error("below 0");  // finds bugprone-throw-keyword-missing
  }
  try {
    return count_of(x);
  } catch (std::runtime_error error) {  // finds misc-throw-by-value-catch-by-reference
    return 0;
  }
}

int branches(int x, int y) {
  if (x > 1 && x > 1) {  // finds misc-redundant-expression
    y = 1;
  }
  if (x > 2)
    y = 3;
    x = 1;  // finds readability-misleading-indentation
  if (x > 3) {  // finds bugprone-branch-clone
    y += 2;
  } else {
    y += 2;
  }
  if (x > 4);  // finds bugprone-suspicious-semicolon
  {
    ++y;
  }
  while (y > 0) {  // finds bugprone-infinite-loop
    std::abs(x);
  }
  return y;
}

bool simple(bool a) {
  if (a) return true;  // finds readability-simplify-boolean-expr
  return false;
}

int compared(const char* a, const std::string& b, const std::string& c) {
  if (std::strcmp(a, "x") == -1) return 1;       // finds bugprone-suspicious-string-compare
  if (b.compare(c) == 0) return 2;               // finds readability-string-compare
  const std::string empty = "";                  // finds readability-redundant-string-init
  const std::string same = b.c_str();            // finds readability-redundant-string-cstr
  const std::string text("x", 0);                // finds bugprone-string-constructor
  return static_cast<int>(empty.size() + same.size() + text.size() + sizeof(b));  // finds bugprone-sizeof-container
}

void returned(std::unique_ptr<int>& pointer, int* raw) {  // finds readability-non-const-parameter
  *pointer.get() = *raw;        // finds readability-redundant-smartptr-get
  if (raw != nullptr) delete raw;  // finds readability-delete-null-pointer
  Base();  // finds bugprone-unused-raii
  std::memset(pointer.get(), '0', sizeof(int));  // finds bugprone-suspicious-memset-usage
  return;  // finds readability-redundant-control-flow
}

long narrow(int a, int b, long many) {
  for (short k = 0; k < many; ++k) {  // finds bugprone-too-small-loop-variable
    a += k;
  }
  do {
    if (a > 0) continue;  // finds bugprone-terminating-continue
  } while (false);
  return static_cast<long>(a * b);  // finds bugprone-misplaced-widening-cast
}

struct Counted {
  static int count;
};

int statically(const Counted& counted) { return counted.count; }  // finds readability-static-accessed-through-instance

constexpr double wrong_constant = 2;  // finds readability-identifier-naming

}  // namespace fluxel
