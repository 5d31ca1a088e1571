#include "app/reference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "app/convergence.hpp"
#include "app/describe.hpp"
#include "app/end_of_run.hpp"
#include "app/json_parts.hpp"
#include "app/load_scene.hpp"
#include "app/reference_elements.hpp"
#include "app/version_text.hpp"
#include "core/file.hpp"
#include "core/hash.hpp"
#include "image/exr_writer.hpp"
#include "image/png_writer.hpp"
#include "image/tone_map.hpp"
#include "metrics/progress_recorder.hpp"
#include "mpi_master/agreement.hpp"
#include "mpi_master/machine.hpp"
#include "mpi_master/reference_job.hpp"
#include "mpi_master/transfer.hpp"
#include "visibility/instruction_set.hpp"

namespace fluxel {

namespace {

using Clock = std::chrono::steady_clock;

/// Layers of a reference's file, by the names that compare knows.
using Layers = std::map<std::string, std::vector<Rgb>, std::less<>>;

/// Of the sensors [first, first + count), each layer's name made by `named`.
template <class Named>
void add_layers(const ReferenceResult& result, std::size_t first, std::size_t count, const Named& named,
                Layers& layers) {
  const auto add = [&](const char* name, auto member) {
    std::vector<Rgb>& layer = layers[named(name)];
    for (std::size_t k = first; k < first + count; ++k) layer.push_back(result.sensors[k].*member);
  };
  add("", &SensorEstimate::mean);
  add("error", &SensorEstimate::error);
  add("half_a", &SensorEstimate::half_a);
  add("half_b", &SensorEstimate::half_b);
}

LayeredImage image_of(const ReferenceResult& result, int width, int height) {
  LayeredImage image{width, height, {}};
  add_layers(
      result, 0, image.pixels(), [](const char* name) { return std::string(name); }, image.layers);
  return image;
}

std::filesystem::path receiver_file(const std::filesystem::path& folder, const Receiver& receiver) {
  return folder / ("receiver-" + receiver.name + ".exr");
}

/// All files that a reference may write.
std::vector<std::filesystem::path> outputs_of(const std::filesystem::path& folder,
                                              const std::vector<Receiver>& receivers) {
  std::vector<std::filesystem::path> files{folder / "reference.ply", folder / "reference.exr",
                                           folder / "reference.png", folder / "reference.json",
                                           folder / "convergence.csv"};
  for (const Receiver& receiver : receivers) files.push_back(receiver_file(folder, receiver));
  return files;
}

class ReferenceRun {
 public:
  ReferenceRun(const Communicator& world, const ReferenceOptions& options, const Scene& scene, int threads,
               ProgressDisplay& display)
      : world_(world),
        options_(options),
        teller_(world, options.run),
        threads_(threads),
        scene_(scene),
        ray_scene_(scene, threads),
        paths_(ray_scene_),
        progress_(display, keep_convergence(world, options.run)) {}

  /// Radiosity of the elements of a file, which the root has read.
  void measure_elements(const ElementFile& read, const std::vector<ElementShape>& shapes) {
    const auto sensors = element_sensors(paths_, scene_, shapes);
    const ReferenceResult result = run("elements", *sensors);
    on_root(world_, [&] {
      Layers layers;
      for (std::size_t side = 0; side < sensors->size() / shapes.size(); ++side)
        add_layers(
            result, side * shapes.size(), shapes.size(),
            [&](const std::string& name) {
              return (name.empty() ? kRadiosity : name) + (side == 0 ? "" : "_back");
            },
            layers);
      std::vector<ElementLayer> list;
      for (const auto& [name, values] : layers) list.push_back({name, values});
      const auto file = folder() / "reference.ply";
      write_element_file(file, read.elements, list);
      teller_.say("elements: {}", file.string());
    });
  }

  void measure_picture(const Camera& camera) {
    const ReferenceResult result =
        run("picture", *pixel_sensors(paths_, scene_, camera, options_.supersample));
    on_root(world_, [&] {
      LayeredImage image = image_of(result, camera.width, camera.height);
      write_exr(folder() / "reference.exr", image, attributes());
      Picture picture;
      picture.width = camera.width;
      picture.height = camera.height;
      picture.radiance = std::move(image.layers[""]);
      picture.reflectance.assign(picture.pixels(), Rgb(0));
      picture.irradiance = picture.reflectance;
      write_png(folder() / "reference.png", tone_map(picture, options_.run.exposure));
      teller_.say("picture: {}", (folder() / "reference.exr").string());
    });
  }

  void measure_receiver(const Receiver& receiver) {
    const ReferenceResult result = run("receiver " + receiver.name, *cell_sensors(paths_, receiver));
    on_root(world_, [&] {
      const auto file = receiver_file(folder(), receiver);
      write_exr(file, image_of(result, receiver.columns, receiver.rows), attributes());
      teller_.say("receiver: {}", file.string());
    });
  }

  /// Of all that has been measured.
  int finish(double load_seconds) {
    on_root(world_, [&] {
      Json json{{"scene", options_.run.scene},
                {"version", version_text()},
                {"ranks", world_.size()},
                {"threads", threads_},
                {"seed", options_.seed},
                {"randomisations", kRandomisations},
                {"load_s", load_seconds},
                {"measured", measured_},
                {"forecasts", forecasts_json(progress_.records())}};
      write_convergence(folder() / "convergence.csv", progress_.records());
      write_bytes_atomically(folder() / "reference.json", json.dump(2) + "\n");
    });
    if (stopped_) return kStopped;
    return reached_ ? 0 : 3;
  }

 private:
  [[nodiscard]] std::filesystem::path folder() const { return options_.run.out; }

  [[nodiscard]] std::map<std::string, std::string> attributes() const {
    return {{"fluxel.version", version_text()},
            {"fluxel.scene", options_.run.scene},
            {"fluxel.seed", fmt::format("{}", options_.seed)}};
  }

  ReferenceResult run(const std::string& name, const Sensors& sensors) {
    const auto start = Clock::now();
    progress_.begin(name);
    // Elements, pixels and the cells of each receiver have numbers of their own, so that their errors are
    // independent.
    const std::uint64_t seed = hash_bytes(std::as_bytes(std::span(name)), options_.seed);
    ReferenceResult result = measure(world_, sensors, options_.limits, seed, threads_, progress_);
    progress_.end();
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    const Rgb& error = result.relative_error;
    teller_.say("{}: {} sensors, {} paths each, {:.3g} rays, {:.2f} s; standard error {:.3g} % of the mean",
                name, sensors.size(), kRandomisations * result.samples, static_cast<double>(result.rays),
                seconds, 100 * std::max({error.r, error.g, error.b}));
    if (!result.reached && !result.stopped && world_.is_root())
      fmt::print(stderr, "warning: {}: the target error is not reached within the other limit\n", name);
    reached_ = reached_ && result.reached;
    stopped_ = stopped_ || result.stopped;
    Json turns = Json::array();
    for (const ReferenceTurn& turn : result.turns)
      turns.push_back({{"samples", turn.samples},
                       {"rays", turn.rays},
                       {"seconds", turn.seconds},
                       {"cpu_s", turn.processor_seconds},
                       {"relative_error_rgb", triple(turn.relative_error)}});
    measured_[name] = {{"sensors", sensors.size()},
                       {"samples", result.samples},
                       {"rays", result.rays},
                       {"seconds", seconds},
                       {"mean_rgb", triple(result.mean)},
                       {"relative_error_rgb", triple(error)},
                       {"reached", result.reached},
                       {"turns", turns}};
    return result;
  }

  const Communicator& world_;
  const ReferenceOptions& options_;
  Teller teller_;
  int threads_;
  const Scene& scene_;
  RayScene ray_scene_;
  LightPaths paths_;
  ProgressRecorder progress_;
  Json measured_ = Json::object();
  bool reached_ = true, stopped_ = false;
};

}  // namespace

int run_reference(const Communicator& world, const ReferenceRequest& request, ProgressDisplay& display,
                  Clock::time_point start) {
  // 1. The root reads and checks; everybody gets the options, the scene and the elements.
  ReferenceOptions options = request.options;
  broadcast(world, options);
  agree(world, [&] { use_instruction_set(options.run.isa); });
  on_root(world, [&] {
    std::vector<std::filesystem::path> inputs = request.input.files;
    if (options.measures_elements()) inputs.emplace_back(options.elements);
    require_inputs_kept(inputs, outputs_of(options.run.out, request.input.receivers));
    require_writable_folder(options.run.out);
  });
  const Scene scene = load_scene(world, options.run, request.input);
  ElementFile elements;
  std::vector<ElementShape> shapes;
  on_root(world, [&] {
    if (!options.measures_elements()) return;
    elements = read_element_file(options.elements);
    shapes = shapes_on_scene(options.elements, elements, scene);
  });
  shapes = world.all_gather(std::span<const ElementShape>(shapes));
  const int threads = rank_places(world, options.run.threads)[static_cast<std::size_t>(world.rank())].threads;
  ReferenceRun run(world, options, scene, threads, display);
  const double load_seconds = std::chrono::duration<double>(Clock::now() - start).count();

  // 2. What is asked for, one after another.
  if (!shapes.empty()) run.measure_elements(elements, shapes);
  if (options.measures_picture() && !anybody_stops(world)) run.measure_picture(*options.run.camera);
  for (const Receiver& receiver : scene.receivers)
    if (options.measures(Measured::receivers) && !anybody_stops(world)) run.measure_receiver(receiver);

  // 3. How exact it is.
  return run.finish(load_seconds);
}

}  // namespace fluxel
