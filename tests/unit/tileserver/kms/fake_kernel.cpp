// SPDX-License-Identifier: MIT
#include "tests/unit/tileserver/kms/fake_kernel.h"

#include <drm.h>
#include <drm_fourcc.h>
#include <drm_mode.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdarg>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "common/base/assert.h"
#include "tests/unit/tileserver/kms/edid_data.h"

namespace wall::tileserver::test {
namespace {

constexpr std::uint32_t kEncoders = 400, kEdids = 500;  // numbers of the first
constexpr std::uint64_t kPage = 4096;
constexpr std::string_view kDriver = "fake";

FakeKernel* the_one = nullptr;

template <class T>
T* pointer(std::uint64_t address) {
    return reinterpret_cast<T*>(static_cast<std::uintptr_t>(address));
}

/// As the kernel does: what there is room for, and in any case how many there are.
template <class T, class Count>
void give(const std::vector<T>& all, std::uint64_t address, Count& count) {
    if (count >= all.size() && address != 0) std::ranges::copy(all, pointer<T>(address));
    count = static_cast<Count>(all.size());
}

std::uint32_t bits_of(const std::vector<CrtcId>& crtcs, const Card& card) {
    std::uint32_t out = 0;
    for (std::size_t i = 0; i < card.crtcs.size(); ++i)
        if (std::ranges::count(crtcs, card.crtcs[i].id) > 0) out |= 1u << i;
    return out;
}

template <class Object>
std::vector<std::uint32_t> numbers_of(const std::vector<Object>& all) {
    std::vector<std::uint32_t> out;
    for (const auto& object : all) out.push_back(object.id.value);
    return out;
}

drm_mode_modeinfo timing_of(const Mode& mode) {
    drm_mode_modeinfo out{};
    out.hdisplay = static_cast<std::uint16_t>(mode.width);
    out.vdisplay = static_cast<std::uint16_t>(mode.height);
    out.htotal = out.vtotal = 1000;  // so that the clock in kHz is the rate in thousandths of Hz
    out.clock = mode.millihertz;
    out.type = mode.preferred ? DRM_MODE_TYPE_PREFERRED : 0;
    return out;
}

}  // namespace

FakeKernel::FakeKernel(FakeDrm& drm)
    : drm_(drm),
      terminal_(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)),
      memory_(::memfd_create("card", MFD_CLOEXEC)) {
    WALL_ASSERT(the_one == nullptr && terminal_ && memory_);
    WALL_ASSERT(::grantpt(terminal_.get()) == 0 && ::unlockpt(terminal_.get()) == 0);
    path_ = ::ptsname(terminal_.get());
    termios raw{};
    WALL_ASSERT(::tcgetattr(terminal_.get(), &raw) == 0);
    ::cfmakeraw(&raw);
    WALL_ASSERT(::tcsetattr(terminal_.get(), TCSANOW, &raw) == 0);
    the_one = this;
}

FakeKernel::~FakeKernel() { the_one = nullptr; }

FakeKernel* FakeKernel::of(int file) {
    if (the_one == nullptr) return nullptr;
    struct stat opened {
    }, ours{};
    const bool same = ::fstat(file, &opened) == 0 && ::stat(the_one->path_.c_str(), &ours) == 0 &&
                      S_ISCHR(opened.st_mode) && opened.st_rdev == ours.st_rdev;
    return same ? the_one : nullptr;
}

std::size_t FakeKernel::buffers() const {
    const std::lock_guard lock(mutex_);
    return buffers_.size();
}

void FakeKernel::beat() {
    const std::lock_guard lock(mutex_);
    drm_.beat();
    const auto told = drm_.take_flips();
    for (const CrtcId crtc : *told) {
        drm_event_vblank event{};
        event.base.type = DRM_EVENT_FLIP_COMPLETE;
        event.base.length = sizeof event;
        event.crtc_id = crtc.value;
        WALL_ASSERT(::write(terminal_.get(), &event, sizeof event) == sizeof event);
    }
}

std::uint32_t FakeKernel::pixel_at(const std::string& connector, std::uint32_t x, std::uint32_t y) const {
    const std::lock_guard lock(mutex_);
    const Buffer& buffer = buffers_.at(framebuffers_.at(drm_.shown_at(connector)));
    std::uint32_t out = 0;
    const auto place = static_cast<off_t>(buffer.offset + std::uint64_t{y} * buffer.pitch + std::uint64_t{x} * 4);
    WALL_ASSERT(::pread(memory_.get(), &out, sizeof out, place) == sizeof out);
    return out & 0xffffff;
}

void* FakeKernel::map(std::size_t size, int protection, std::int64_t offset) const {
    return reinterpret_cast<void*>(::syscall(SYS_mmap, nullptr, size, protection, MAP_SHARED, memory_.get(), offset));
}

const std::map<unsigned long, FakeKernel::Answer>& FakeKernel::answers() {
    static const std::map<unsigned long, Answer> all{
        {DRM_IOCTL_VERSION, &FakeKernel::version},
        {DRM_IOCTL_GET_CAP, &FakeKernel::capability},
        {DRM_IOCTL_SET_CLIENT_CAP, &FakeKernel::client_capability},
        {DRM_IOCTL_AUTH_MAGIC, &FakeKernel::authorize},
        {DRM_IOCTL_SET_MASTER, &FakeKernel::set_master},
        {DRM_IOCTL_DROP_MASTER, &FakeKernel::done},
        {DRM_IOCTL_GEM_CLOSE, &FakeKernel::free_buffer},
        {DRM_IOCTL_MODE_GETRESOURCES, &FakeKernel::resources},
        {DRM_IOCTL_MODE_GETCONNECTOR, &FakeKernel::connector},
        {DRM_IOCTL_MODE_GETENCODER, &FakeKernel::encoder},
        {DRM_IOCTL_MODE_GETPLANERESOURCES, &FakeKernel::plane_resources},
        {DRM_IOCTL_MODE_GETPLANE, &FakeKernel::plane},
        {DRM_IOCTL_MODE_OBJ_GETPROPERTIES, &FakeKernel::properties},
        {DRM_IOCTL_MODE_GETPROPERTY, &FakeKernel::property},
        {DRM_IOCTL_MODE_GETPROPBLOB, &FakeKernel::blob},
        {DRM_IOCTL_MODE_CREATEPROPBLOB, &FakeKernel::make_blob},
        {DRM_IOCTL_MODE_DESTROYPROPBLOB, &FakeKernel::free_blob},
        {DRM_IOCTL_MODE_ADDFB2, &FakeKernel::add_framebuffer},
        {DRM_IOCTL_MODE_RMFB, &FakeKernel::remove_framebuffer},
        {DRM_IOCTL_MODE_ATOMIC, &FakeKernel::commit},
        {DRM_IOCTL_MODE_CREATE_DUMB, &FakeKernel::make_buffer},
        {DRM_IOCTL_MODE_MAP_DUMB, &FakeKernel::map_buffer},
        {DRM_IOCTL_MODE_DESTROY_DUMB, &FakeKernel::free_buffer},
    };
    return all;
}

int FakeKernel::answer(unsigned long request, void* argument) {
    const std::lock_guard lock(mutex_);
    const auto found = answers().find(request);
    return found == answers().end() ? ENOTTY : (this->*found->second)(argument);
}

int FakeKernel::version(void* argument) {
    auto& out = *static_cast<drm_version*>(argument);
    const auto say = [](std::string_view text, char* room, auto& length) {
        if (room != nullptr && length >= text.size()) std::ranges::copy(text, room);
        length = text.size();
    };
    say(kDriver, out.name, out.name_len);
    say(kDriver, out.date, out.date_len);
    say(kDriver, out.desc, out.desc_len);
    return 0;
}

int FakeKernel::capability(void* argument) {
    auto& out = *static_cast<drm_get_cap*>(argument);
    out.value = out.capability == DRM_CAP_DUMB_BUFFER ? 1 : 0;
    return 0;
}

int FakeKernel::client_capability(void* argument) {
    const auto& wanted = *static_cast<const drm_set_client_cap*>(argument);
    return wanted.capability == DRM_CLIENT_CAP_ATOMIC && !atomic ? EOPNOTSUPP : 0;
}

/// By which drmIsMaster() finds it out: only the master is told that nobody asked.
int FakeKernel::authorize(void*) { return nobody_is_master ? EINVAL : EACCES; }

int FakeKernel::set_master(void*) { return nobody_is_master ? 0 : EACCES; }

int FakeKernel::resources(void* argument) {
    auto& out = *static_cast<drm_mode_card_res*>(argument);
    std::vector<std::uint32_t> encoders;
    for (std::uint32_t i = 0; i < drm_.card.connectors.size(); ++i) encoders.push_back(kEncoders + i);
    give(numbers_of(drm_.card.crtcs), out.crtc_id_ptr, out.count_crtcs);
    give(numbers_of(drm_.card.connectors), out.connector_id_ptr, out.count_connectors);
    give(encoders, out.encoder_id_ptr, out.count_encoders);
    out.count_fbs = 0;
    out.max_width = out.max_height = 16384;
    return 0;
}

int FakeKernel::connector(void* argument) {
    auto& out = *static_cast<drm_mode_get_connector*>(argument);
    const auto found = std::ranges::find(drm_.card.connectors, ConnectorId(out.connector_id), &Connector::id);
    if (found == drm_.card.connectors.end()) return ENOENT;
    const auto number = static_cast<std::uint32_t>(found - drm_.card.connectors.begin());
    std::vector<drm_mode_modeinfo> modes;
    for (const Mode& mode : found->modes) modes.push_back(timing_of(mode));
    give(modes, out.modes_ptr, out.count_modes);
    give(std::vector{kEncoders + number}, out.encoders_ptr, out.count_encoders);
    out.count_props = 0;
    out.connector_type = found->name.starts_with("DP") ? DRM_MODE_CONNECTOR_DisplayPort : DRM_MODE_CONNECTOR_HDMIA;
    out.connector_type_id = static_cast<std::uint32_t>(found->name.back() - '0');
    out.connection = found->connected ? 1 : 2;
    return 0;
}

int FakeKernel::encoder(void* argument) {
    auto& out = *static_cast<drm_mode_get_encoder*>(argument);
    const auto number = out.encoder_id - kEncoders;
    if (number >= drm_.card.connectors.size()) return ENOENT;
    out.possible_crtcs = bits_of(drm_.card.connectors[number].crtcs, drm_.card);
    return 0;
}

int FakeKernel::plane_resources(void* argument) {
    auto& out = *static_cast<drm_mode_get_plane_res*>(argument);
    give(numbers_of(drm_.card.planes), out.plane_id_ptr, out.count_planes);
    return 0;
}

int FakeKernel::plane(void* argument) {
    auto& out = *static_cast<drm_mode_get_plane*>(argument);
    const auto found = std::ranges::find(drm_.card.planes, PlaneId(out.plane_id), &Plane::id);
    if (found == drm_.card.planes.end()) return ENOENT;
    const std::uint32_t format = found->plain ? DRM_FORMAT_XRGB8888 : DRM_FORMAT_NV12;
    give(std::vector{format}, out.format_type_ptr, out.count_format_types);
    out.possible_crtcs = bits_of(found->crtcs, drm_.card);
    return 0;
}

const Properties* FakeKernel::properties_of(std::uint32_t object) const {
    for (const auto& at : drm_.card.connectors)
        if (at.id.value == object) return &at.properties;
    for (const auto& at : drm_.card.crtcs)
        if (at.id.value == object) return &at.properties;
    for (const auto& at : drm_.card.planes)
        if (at.id.value == object) return &at.properties;
    return nullptr;
}

std::uint64_t FakeKernel::value_of(std::uint32_t object, const std::string& name) const {
    if (name == "type") return std::ranges::find(drm_.card.planes, PlaneId(object), &Plane::id)->primary ? 1 : 0;
    if (name != "EDID" && name != "link-status") return drm_.value(object, name);
    const auto at = std::ranges::find(drm_.card.connectors, ConnectorId(object), &Connector::id);
    if (name == "link-status") return at->link_bad ? 1 : 0;
    return at->connected ? kEdids + static_cast<std::uint32_t>(at - drm_.card.connectors.begin()) : 0;
}

int FakeKernel::properties(void* argument) {
    auto& out = *static_cast<drm_mode_obj_get_properties*>(argument);
    const auto* found = properties_of(out.obj_id);
    if (found == nullptr) return ENOENT;
    std::vector<std::uint32_t> ids;
    std::vector<std::uint64_t> values;
    for (const auto& [name, property] : *found) {
        ids.push_back(property.id.value);
        values.push_back(value_of(out.obj_id, name));
    }
    auto count = out.count_props;
    give(values, out.prop_values_ptr, count);
    give(ids, out.props_ptr, out.count_props);
    return 0;
}

int FakeKernel::property(void* argument) {
    auto& out = *static_cast<drm_mode_get_property*>(argument);
    std::strncpy(out.name, name_of(PropertyId(out.prop_id)).c_str(), sizeof out.name - 1);
    out.count_values = out.count_enum_blobs = 0;
    return 0;
}

int FakeKernel::blob(void* argument) {
    auto& out = *static_cast<drm_mode_get_blob*>(argument);
    const auto number = out.blob_id - kEdids;
    if (number >= drm_.card.connectors.size()) return ENOENT;
    auto data = edid_without_name();
    add_text(data, 0xfc, drm_.card.connectors[number].monitor + "\n");
    put_sum_right(data);
    give(std::vector(data.begin(), data.end()), out.data, out.length);
    return 0;
}

int FakeKernel::make_blob(void* argument) {
    auto& out = *static_cast<drm_mode_create_blob*>(argument);
    if (out.length != sizeof(drm_mode_modeinfo)) return EINVAL;
    out.blob_id = drm_.make_blob({pointer<const std::byte>(out.data), out.length})->value;
    return 0;
}

int FakeKernel::free_blob(void* argument) {
    drm_.free_blob(BlobId(static_cast<const drm_mode_destroy_blob*>(argument)->blob_id));
    return 0;
}

int FakeKernel::add_framebuffer(void* argument) {
    auto& out = *static_cast<drm_mode_fb_cmd2*>(argument);
    const auto buffer = buffers_.find(out.handles[0]);
    if (buffer == buffers_.end() || out.pixel_format != DRM_FORMAT_XRGB8888 || out.pitches[0] < out.width * 4)
        return EINVAL;
    BufferLayout layout;
    layout.width = out.width;
    layout.height = out.height;
    const auto added = *drm_.add_framebuffer(layout);
    framebuffers_[added] = out.handles[0];
    out.fb_id = added.value;
    return 0;
}

int FakeKernel::remove_framebuffer(void* argument) {
    const FramebufferId framebuffer(*static_cast<const std::uint32_t*>(argument));
    drm_.remove_framebuffer(framebuffer);
    framebuffers_.erase(framebuffer);
    return 0;
}

int FakeKernel::commit(void* argument) {
    const auto& in = *static_cast<const drm_mode_atomic*>(argument);
    std::vector<PropertyChange> changes;
    std::size_t next = 0;
    for (std::size_t object = 0; object < in.count_objs; ++object)
        for (std::uint32_t i = 0; i < pointer<const std::uint32_t>(in.count_props_ptr)[object]; ++i, ++next)
            changes.push_back({pointer<const std::uint32_t>(in.objs_ptr)[object],
                               PropertyId(pointer<const std::uint32_t>(in.props_ptr)[next]),
                               pointer<const std::uint64_t>(in.prop_values_ptr)[next]});
    const bool flip = (in.flags & DRM_MODE_ATOMIC_ALLOW_MODESET) == 0,
               tells = (in.flags & DRM_MODE_PAGE_FLIP_EVENT) != 0;
    if (flip && (in.flags & DRM_MODE_ATOMIC_NONBLOCK) == 0) return EINVAL;
    const auto kind = flip ? CommitKind::flip : tells ? CommitKind::mode : CommitKind::dark;
    return static_cast<int>(drm_.commit(changes, kind));
}

int FakeKernel::make_buffer(void* argument) {
    auto& out = *static_cast<drm_mode_create_dumb*>(argument);
    out.pitch = (out.width * out.bpp / 8 + 63) / 64 * 64;
    out.size = (std::uint64_t{out.pitch} * out.height + kPage - 1) / kPage * kPage;
    out.handle = next_handle_++;
    buffers_[out.handle] = {out.pitch, memory_size_};
    memory_size_ += out.size;
    return ::ftruncate(memory_.get(), static_cast<off_t>(memory_size_)) == 0 ? 0 : ENOMEM;
}

int FakeKernel::map_buffer(void* argument) {
    auto& out = *static_cast<drm_mode_map_dumb*>(argument);
    const auto found = buffers_.find(out.handle);
    if (found == buffers_.end()) return ENOENT;
    out.offset = found->second.offset;
    return 0;
}

int FakeKernel::free_buffer(void* argument) {
    return buffers_.erase(*static_cast<const std::uint32_t*>(argument)) != 0 ? 0 : EINVAL;
}

namespace {

void* map(void* address, std::size_t size, int protection, int flags, int file, std::int64_t offset) {
    if (const auto* kernel = file >= 0 ? FakeKernel::of(file) : nullptr) return kernel->map(size, protection, offset);
    return reinterpret_cast<void*>(::syscall(SYS_mmap, address, size, protection, flags, file, offset));
}

}  // namespace
}  // namespace wall::tileserver::test

#define EVERYBODYS __attribute__((visibility("default")))

extern "C" EVERYBODYS int ioctl(int file, unsigned long request, ...) noexcept {
    va_list rest;
    va_start(rest, request);
    void* argument = va_arg(rest, void*);
    va_end(rest);
    auto* kernel = _IOC_TYPE(request) == DRM_IOCTL_BASE ? wall::tileserver::test::FakeKernel::of(file) : nullptr;
    if (kernel == nullptr) return static_cast<int>(::syscall(SYS_ioctl, file, request, argument));
    const int error = kernel->answer(request, argument);
    if (error == 0) return 0;
    errno = error;
    return -1;
}

extern "C" EVERYBODYS void* mmap(void* address, std::size_t size, int protection, int flags, int file,
                                 off_t offset) noexcept {
    return wall::tileserver::test::map(address, size, protection, flags, file, offset);
}

extern "C" EVERYBODYS void* mmap64(void* address, std::size_t size, int protection, int flags, int file,
                                   off64_t offset) noexcept {
    return wall::tileserver::test::map(address, size, protection, flags, file, offset);
}
