"""The precision that networks are trained and measured in."""

from typing import Any

import torch


def autocast(device: torch.device) -> Any:
    """bfloat16 where the device has instructions for it; elsewhere it is slower than float32."""
    if device.type == "cuda":
        fast = torch.cuda.get_device_capability(device)[0] >= 8
    else:
        has = ("_is_amx_tile_supported", "_is_avx512_bf16_supported")
        fast = any(getattr(torch.cpu, name, lambda: False)() for name in has)
    # Every weight is used once a step, and what is kept of one step would be missing in a recorded one.
    return torch.autocast(device.type, torch.bfloat16, enabled=fast, cache_enabled=False)
