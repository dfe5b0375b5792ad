"""Averages of a network's weights over the steps of training."""

from typing import Any

import torch
from torch import nn

# The average's spread is a tenth of the steps so far.
_EXPONENT = 6.94


class Average:
    """The weights and statistics of `model`, averaged over its steps by a power of their number.

    The power function of Karras et al. 2024 ("Analyzing and Improving the Training Dynamics of Diffusion Models") has at
    any step what an average over that many steps alone would have, so that one run stands for runs of every length.
    """

    def __init__(self, model: nn.Module, steps: int, device: torch.device):
        self._of = _numbers(model)
        self._means = [tensor.detach().clone() for tensor in self._of]
        kept = (1 - 1 / torch.arange(1, steps + 1, dtype=torch.float64)) ** (_EXPONENT + 1)
        self._shares = (1 - kept).float().to(device)

    def add(self, at: torch.Tensor) -> None:
        """Takes in the weights after step `at` (1,), counted from 0."""
        share = self._shares[at][0]
        for mean, tensor in zip(self._means, self._of):
            mean.lerp_(tensor.detach(), share)

    def put_into(self, model: nn.Module) -> nn.Module:
        """Gives `model` the averaged weights, and returns it."""
        for tensor, mean in zip(_numbers(model), self._means):
            tensor.detach().copy_(mean)
        return model

    def state_dict(self) -> dict[str, Any]:
        return {"means": self._means}

    def load_state_dict(self, state: dict[str, Any]) -> None:
        for mean, loaded in zip(self._means, state["means"]):
            mean.copy_(loaded)


def _numbers(model: nn.Module) -> list[torch.Tensor]:
    """The model's own tensors that can be averaged, its statistics among them."""
    return [tensor for tensor in model.state_dict(keep_vars=True).values() if tensor.is_floating_point()]
