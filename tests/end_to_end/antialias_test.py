"""dbview --samples, --filter, --pattern: pictures that do not depend on the machine, errors that fall, and words that are refused."""
from harness import RAINIER, build, case, main, no_leftovers, require, run

VIEW = ["--eye", "46.80,-121.72,300agl", "--look", "5,-2", "--size", "160x100"]


def picture(folder, area, *options, name="picture.png"):
    run("dbview", area, *VIEW, *options, "-o", folder / name, "--overwrite")
    return (folder / name).read_bytes()


@case
def one_sample_is_the_picture_without_the_option(folder):
    area = build(folder, RAINIER)
    plain = picture(folder, area)
    require(picture(folder, area, "--samples", "1") == plain, "--samples 1 is another picture")
    require(picture(folder, area, "--samples", "1", "--pattern", "ordered") == plain, "one sample has no pattern")
    seen = {plain}
    for options in (["4"], ["4", "--pattern", "ordered"], ["16"], ["64"], ["4", "--filter", "pyramid"], ["4", "--filter", "gaussian"],
                    ["4", "--filter", "mitchell"]):
        seen.add(picture(folder, area, "--samples", *options))
    require(len(seen) == 8, f"{len(seen)} pictures of 8 samplings")
    no_leftovers(folder)


@case
def pictures_do_not_depend_on_threads_or_vectors(folder):
    area = build(folder, RAINIER)
    for sampling in (["--samples", "4"], ["--samples", "16", "--filter", "mitchell"]):
        first = picture(folder, area, *sampling, "-j", "1")
        for options in (["-j", "2"], ["-j", "7"], ["--simd", "portable"], ["--simd", "sse4"]):
            require(picture(folder, area, *sampling, *options) == first, (sampling, options))


@case
def statistics_count_samples(folder):
    area = build(folder, RAINIER)
    one = run("dbview", area, *VIEW, "-o", folder / "1.png", "--json").json()
    many = run("dbview", area, *VIEW, "--samples", "16", "--filter", "gaussian", "--pattern", "ordered", "-o", folder / "16.png", "--json").json()
    require((one["samples"], one["pattern"], one["filter"]) == (1, "rotated", "box"), one)
    require((many["samples"], many["pattern"], many["filter"]) == (16, "ordered", "gaussian"), many)
    one, many = one["frames"][0], many["frames"][0]
    for key in ("tested", "written"):
        require(15 < many["samples"][key] / one["samples"][key] < 17, (key, one["samples"], many["samples"]))
    require(many["samples"]["shaded"] < 3 * one["samples"]["shaded"], "samples are coloured one by one")
    require(many["level"] == one["level"] and many["projected_error"] <= 1, "other levels are drawn")


@case
def more_samples_are_nearer_to_many(folder):
    area = build(folder, RAINIER)
    report = run("dbview", "sweep", area, *VIEW, "--tolerances", "1", "--reference", "1", "--samples", "16,1,4", "--repeat", "1", "--json").json()
    require((report["reference_samples"], report["pattern"], report["filter"]) == (64, "rotated", "box"), report)
    rows = report["all_views"]
    require([row["setting"]["samples"] for row in rows] == [1, 4, 16], rows)
    require(len({row["displacement_pixels"]["largest"] for row in rows}) == 1, "samples move the ground")
    errors = [row["colors"]["rms"] for row in rows]
    require(errors[0] > 1.5 * errors[1] > 2.25 * errors[2] > 0, errors)
    text = run("dbview", "sweep", area, *VIEW, "--tolerances", "1", "--samples", "1,4", "--repeat", "1").out
    require(" samples " in text and "4 samples" in text and "with 64 samples" in text, text)
    # Without samples to try the reference has one, as ever.
    report = run("dbview", "sweep", area, *VIEW, "--tolerances", "1", "--reference", "1", "--repeat", "1", "--json").json()
    require(report["reference_samples"] == 1 and report["all_views"][0]["colors"]["differing_share"] == 0, report)


@case
def what_there_is_not_is_refused(folder):
    area = build(folder)
    for samples in ("0", "2", "5", "-4", "four", "4.0", "128"):
        run("dbview", area, "-o", folder / "x.png", f"--samples={samples}", expect=2, words=["--samples", "1, 4, 16, 64"])
    for option in ("--filter", "--pattern"):
        run("dbview", area, "-o", folder / "x.png", option, "round", expect=2, words=[option, "round"])
    run("dbview", area, "-o", folder / "x.png", "--samples", "64", "--size", "2049x10", expect=2, words=["2049 x 10", "2048", "fewer samples"])
    for samples in ("1,2", "4,4", "1,", "1;4"):
        run("dbview", "sweep", area, "--samples", samples, expect=2, words=["--samples"])
    run("dbview", "sweep", area, "--samples", "1,64", "--size", "4096x16", expect=2, words=["2048"])
    require(not (folder / "x.png").exists(), "a picture was written")


if __name__ == "__main__":
    main()
