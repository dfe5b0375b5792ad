"""TRoVE: recordings of real roads turned into photorealistic virtual scenes with perfect labels."""

from trove._trove import __version__

__all__ = ["__version__"]
