#include "scene/ray_caster.hpp"

#include <embree3/rtcore.h>
#include <tbb/global_control.h>

#include <cstring>
#include <limits>
#include <stdexcept>

namespace cmap {
namespace {

RTCRayHit to_embree(const Ray& ray) {
  RTCRayHit out{};
  out.ray.org_x = ray.origin.x();
  out.ray.org_y = ray.origin.y();
  out.ray.org_z = ray.origin.z();
  out.ray.dir_x = ray.direction.x();
  out.ray.dir_y = ray.direction.y();
  out.ray.dir_z = ray.direction.z();
  out.ray.tfar = ray.max_distance;
  out.ray.mask = 0xffffffff;
  out.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  return out;
}

/// Fills lane i of a packet; lanes beyond the rays are switched off.
template <class PacketRays>
void load_lanes(std::span<const Ray> rays, PacketRays& packet, int* valid) {
  for (std::size_t i = 0; i < RayCaster::kPacket; ++i) {
    valid[i] = i < rays.size() ? -1 : 0;
    const Ray& ray = rays[i < rays.size() ? i : 0];
    packet.org_x[i] = ray.origin.x();
    packet.org_y[i] = ray.origin.y();
    packet.org_z[i] = ray.origin.z();
    packet.dir_x[i] = ray.direction.x();
    packet.dir_y[i] = ray.direction.y();
    packet.dir_z[i] = ray.direction.z();
    packet.tnear[i] = 0.0F;
    packet.tfar[i] = ray.max_distance;
    packet.time[i] = 0.0F;
    packet.mask[i] = 0xffffffff;
    packet.id[i] = 0;
    packet.flags[i] = 0;
  }
}

RTCIntersectContext context_of(RTCIntersectContextFlags flags) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = flags;
  return context;
}

}  // namespace

struct RayCaster::Handles {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  ~Handles() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

RayCaster::RayCaster(std::span<const Eigen::Vector3f> vertices, std::span<const std::array<std::uint32_t, 3>> triangles)
    : handles_(std::make_unique<Handles>()) {
  handles_->device = rtcNewDevice("set_affinity=0");
  if (handles_->device == nullptr) throw std::runtime_error("Embree does not start");
  handles_->scene = rtcNewScene(handles_->device);
  rtcSetSceneFlags(handles_->scene, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry mesh = rtcNewGeometry(handles_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  void* points = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Eigen::Vector3f),
                                         vertices.size());
  void* indices = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                          sizeof(std::array<std::uint32_t, 3>), triangles.size());
  if (points != nullptr) std::memcpy(points, vertices.data(), vertices.size_bytes());
  if (indices != nullptr) std::memcpy(indices, triangles.data(), triangles.size_bytes());
  rtcCommitGeometry(mesh);
  rtcAttachGeometry(handles_->scene, mesh);
  rtcReleaseGeometry(mesh);
  {
    // One thread builds, so that triangles at equal distance are met in the same order in every run. Not by the
    // device's own setting "threads": that would limit all of the process's parallel loops from then on.
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    rtcCommitScene(handles_->scene);
  }
  if (rtcGetDeviceError(handles_->device) != RTC_ERROR_NONE) {
    throw std::runtime_error("Embree cannot build the scene (out of memory?)");
  }
}

RayCaster::~RayCaster() = default;

std::uint32_t RayCaster::first(const Ray& ray) const {
  RTCIntersectContext context = context_of(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
  RTCRayHit hit = to_embree(ray);
  rtcIntersect1(handles_->scene, &context, &hit);
  return hit.hit.geomID == RTC_INVALID_GEOMETRY_ID ? kNone : hit.hit.primID;
}

void RayCaster::first(std::span<const Ray> rays, std::span<std::uint32_t> triangles) const {
  alignas(64) int valid[kPacket];
  alignas(64) RTCRayHit16 packet;
  load_lanes(rays, packet.ray, valid);
  for (unsigned& id : packet.hit.geomID) id = RTC_INVALID_GEOMETRY_ID;
  for (unsigned& id : packet.hit.instID[0]) id = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context = context_of(RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
  rtcIntersect16(valid, handles_->scene, &context, &packet);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    triangles[i] = packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID ? kNone : packet.hit.primID[i];
  }
}

bool RayCaster::is_blocked(const Ray& ray) const {
  RTCIntersectContext context = context_of(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
  RTCRay out = to_embree(ray).ray;
  rtcOccluded1(handles_->scene, &context, &out);
  return out.tfar < 0.0F;
}

void RayCaster::are_blocked(std::span<const Ray> rays, std::span<std::uint8_t> blocked) const {
  alignas(64) int valid[kPacket];
  alignas(64) RTCRay16 packet;
  load_lanes(rays, packet, valid);
  RTCIntersectContext context = context_of(RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
  rtcOccluded16(valid, handles_->scene, &context, &packet);
  for (std::size_t i = 0; i < rays.size(); ++i) blocked[i] = packet.tfar[i] < 0.0F ? 1 : 0;
}

}  // namespace cmap
