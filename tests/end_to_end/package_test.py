"""The installed tree: what is in it, and a program of somebody else that stands on it."""
import os
import pathlib
import subprocess

from harness import RAINIER, build, case, main, require

CMAKE = os.environ["DELTAZ_CMAKE"]
CONSUMER = pathlib.Path(__file__).resolve().parent / "package_consumer"


def command(*words):
    process = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False)
    require(process.returncode == 0, f"{words}:\n{process.stdout}{process.stderr}")
    return process.stdout


def installed(folder):
    prefix = folder / "prefix"
    command(CMAKE, "--install", os.environ["DELTAZ_BUILD"], "--prefix", prefix)
    return prefix


@case
def installation_holds_tools_headers_pages_and_specifications(folder):
    prefix = installed(folder)
    for name in ("bin/dbbuild", "bin/dbview", "bin/dbcheck", "include/deltaz/formats/error.h", "include/deltaz/libdb/access/database.h",
                 "include/deltaz/librender/scene/render.h", "share/man/man1/dbbuild.1", "share/man/man1/dbview.1", "share/man/man1/dbcheck.1",
                 "share/man/man5/deltaz.5", "share/doc/deltaz/formats/container.md", "share/deltaz/report.schema.json"):
        require((prefix / name).is_file(), f"{name} is not installed")
    require(command(prefix / "bin" / "dbcheck", "--version").startswith("dbcheck "), "the installed tool does not run")


@case
def manual_pages_name_every_option(folder):
    prefix = installed(folder)
    for tool, commands in (("dbbuild", ["terrain", "info", "export"]), ("dbview", []), ("dbcheck", [])):
        page = (prefix / "share" / "man" / "man1" / f"{tool}.1").read_text().replace("\\-", "-").replace("\\fB", "").replace("\\fR", "")
        helps = "".join(command(prefix / "bin" / tool, *words, "--help") for words in ([[name] for name in commands] or [[]]))
        common = {"--help", "--version", "--quiet", "--verbose", "--jobs"}
        options = {word.strip(",") for line in helps.splitlines() if line.startswith("  -") for word in line.split()[0].split(",")
                   if word.startswith("--")}
        for option in options - (common if tool != "dbbuild" else set()):
            require(option in page, f"{tool}(1) does not know {option}")


@case
def a_program_of_somebody_else_builds_against_the_package(folder):
    prefix, area = installed(folder), build(folder, RAINIER)
    command(CMAKE, "-S", CONSUMER, "-B", folder / "consumer", "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={prefix}")
    command(CMAKE, "--build", folder / "consumer")
    height = float(command(folder / "consumer" / "consumer", area, "46.853", "-121.760"))
    require(4000 < height < 4400, f"the summit of Mount Rainier at {height} m")


if __name__ == "__main__":
    main()
