"""Where the installed libraries and data lie that the program loads."""

from pathlib import Path

_BODY = Path(__file__).parent / "human_body"


def search() -> list[str]:
    """Folders to look for Embree, Open Image Denoise and MakeHuman's body in, nearest first."""
    import site
    import sysconfig

    packages = [sysconfig.get_path("platlib"), *site.getsitepackages()]
    if site.ENABLE_USER_SITE:
        packages.append(site.getusersitepackages())
    # The package's own body comes last: one that was installed beside it is meant.
    return [*dict.fromkeys(packages), str(_BODY)]
