// SPDX-License-Identifier: Apache-2.0
#include "worker/geometry/embree_version.h"

#include <memory>

#include "common/base/float_traps.h"
#include "worker/geometry/embree_api.h"

namespace treefarm {

std::string embree_version() {
    const LetFloatsBe embree;
    const std::unique_ptr<RTCDeviceTy, decltype(&rtcReleaseDevice)> device(rtcNewDevice("threads=1"),
                                                                           &rtcReleaseDevice);
    if (!device) return "unknown";
    std::string text;
    for (const RTCDeviceProperty part :
         {RTC_DEVICE_PROPERTY_VERSION_MAJOR, RTC_DEVICE_PROPERTY_VERSION_MINOR, RTC_DEVICE_PROPERTY_VERSION_PATCH})
        text += (text.empty() ? "" : ".") + std::to_string(rtcGetDeviceProperty(device.get(), part));
    return text;
}

}  // namespace treefarm
