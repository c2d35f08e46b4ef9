"""The machine that figures come from."""

import os
import platform
import re


def cpuinfo():
    fields = {}
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            for line in file:
                key, _, value = line.partition(":")
                fields.setdefault(key.strip(), value.strip())
    except OSError:
        pass
    return fields


def describe():
    """Name, cores and system."""
    fields = cpuinfo()
    return {"processor": fields.get("model name", platform.processor() or platform.machine()),
            "family": fields.get("cpu family", ""), "model": fields.get("model", ""), "cores": os.cpu_count(),
            "system": f"{platform.system()} {platform.release()}"}


def title(found=None):
    """A described machine, by default this one, in a few words. Processors in clouds often have no better name than
    their family and model.
    """
    found = found or describe()
    numbers = f" (family {found['family']}, model {found.get('model', '')})" if found.get("family") else ""
    return f"{found.get('processor', 'unknown processor')}{numbers}, {found.get('cores', 'unknown')} cores"


def slug():
    """A name for folders: intel-6-167."""
    fields = cpuinfo()
    vendor = {"GenuineIntel": "intel", "AuthenticAMD": "amd"}.get(fields.get("vendor_id", ""), platform.machine())
    parts = [vendor, fields.get("cpu family", ""), fields.get("model", "")]
    return re.sub(r"[^a-z0-9.]+", "-", "-".join(part for part in parts if part).lower())


def busy():
    """A sentence if other work is under way, otherwise nothing."""
    try:
        load = os.getloadavg()[0]
    except OSError:
        return None
    cores = os.cpu_count() or 1
    if load < 0.5 * cores:
        return None
    return f"the machine is busy: a load of {load:.1f} on {cores} cores"
