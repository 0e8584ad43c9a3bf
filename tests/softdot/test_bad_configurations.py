"""Every mistake in a configuration: one sentence, exit 2, nothing written."""

import pytest

from softdot.cli import main
from tests.softdot.conftest import MINIMAL


def refusal(arguments, tmp_path, capfd):
    """The one sentence with which the command line refuses; checks that nothing was written."""
    before = sorted(tmp_path.rglob("*"))
    assert main(arguments) == 2
    printed = capfd.readouterr()
    assert printed.out == ""
    assert printed.err.startswith("softdot: ")
    assert printed.err.count("\n") == 1
    assert sorted(tmp_path.rglob("*")) == before
    return printed.err.removeprefix("softdot: ").rstrip("\n")


PRONY = (
    "[[mechanisms]]\nname = 'viscoelasticity'\ncomponent = 'medium2'\n"
    "parameters = {{relative_moduli = {}, relaxation_times_s = {}}}"
)

NUMBER = "must be a plain number; its unit is part of the key"
BOND = "normal_stiffness_N_per_mm3 = 1.0\nshear_stiffness_N_per_mm3 = 1.0"
CASES = {
    # unknown keys
    "[dott]": "dott is not a key; did you mean 'dot'?",
    "[effector]": "effector is not a key; did you mean 'segment.effector'?",
    "[dot]\nofset_mm = [0.0, 0.0]": "dot.ofset_mm is not a key; did you mean 'offset_mm'?",
    "[press]\nzzz = 1": "press.zzz is not a key; known are force_N, indentation_mm, load_steps, path_xy_mm, waveform",
    "[materials.x]\nmodel = 'yeoh'\nc10 = 1.0": "materials.x.c10 is not a key; did you mean 'c10_MPa'?",
    "[[segment.film.electrodes]]\nnaem = 'a'": "segment.film.electrodes[0].naem is not a key; did you mean 'name'?",
    # numbers that are none
    "[press]\nindentation_mm = '0.3 mm'": f"press.indentation_mm = '0.3 mm': {NUMBER}",
    "[press]\nindentation_mm = '0.3'": f"press.indentation_mm = '0.3': {NUMBER}",
    "[press]\nindentation_mm = true": f"press.indentation_mm = true: {NUMBER}",
    "[press]\nindentation_mm = nan": "press.indentation_mm = nan: must be a finite number",
    "[press]\nindentation_mm = inf": "press.indentation_mm = inf: must be a finite number",
    "[press]\nindentation_mm = 1e999": "press.indentation_mm = inf: must be a finite number",
    "[press]\nload_steps = 2.5": "press.load_steps = 2.5: must be a whole number",
    "[dot]\noffset_mm = 1.0": "dot.offset_mm = 1: must be a list in square brackets",
    "[dot]\noffset_mm = [1.0]": "dot.offset_mm[1] is missing",
    "[dot]\noffset_mm = [1.0, 'a']": f"dot.offset_mm[1] = 'a': {NUMBER}",
    "[press]\nwaveform = 3": "press.waveform = 3: must be a table",
    # numbers out of range
    "[press]\nindentation_mm = 0.0": "press.indentation_mm = 0: must be above 0",
    "[press]\nindentation_mm = -0.3": "press.indentation_mm = -0.3: must be above 0",
    "[press]\nindentation_mm = 1e200": ("press.indentation_mm = 1e+200: must be at most 1e+12 in size"),
    "[dot]\nbase_diameter_mm = 1e-200": "dot.base_diameter_mm = 0: must be above 0",
    "[press]\nload_steps = 0": "press.load_steps = 0: must be at least 1",
    "[dot]\ncell_dot = 9": "dot.cell_dot = 9: must be at most 8",
    "[segment]\nlength_mm = -2.5": "segment.length_mm = -2.5: must be above 0",
    "[segment.effector]\nheight_mm = 0.0": "segment.effector.height_mm = 0: must be above 0",
    # choices
    "[mesh]\nmesher = 'gmsh'": "mesh.mesher = 'gmsh': must be 'pytetwild' or 'layered'",
    "[segment]\nheld_layers = ['efector']": (
        "segment.held_layers[0] = 'efector': must be 'effector', 'medium1', 'film' or 'medium2'"
    ),
    "[press]\nindentation_mm = 0.3\nforce_N = 2.0": (
        "press.force_N = 2: give either indentation_mm or force_N, not both"
    ),
    "[readout]\nmode = 'charge'": "readout.feedback_pF is missing: mode = 'charge' needs it",
    "[press.waveform]\nshape = 'file'": "press.waveform.file is missing: shape = 'file' needs it",
    # materials
    "[materials.vnr]\npoisson_ratio = 0.5": "materials.vnr.poisson_ratio = 0.5: must be above -1 and below 0.5",
    "[materials.vnr]\npoisson_ratio = -1.0": "materials.vnr.poisson_ratio = -1: must be above -1 and below 0.5",
    "[materials.vnr]\npoisson_ratio = nan": "materials.vnr.poisson_ratio = nan: must be above -1 and below 0.5",
    "[materials.vnr]\nyoungs_modulus_MPa = -5.0": "materials.vnr.youngs_modulus_MPa = -5: must be above 0",
    "[materials.x]\nmodel = 'neo-hookean'": ("materials.x.youngs_modulus_MPa is missing: small-strain Young's modulus"),
    "[materials.x]\nmodel = 'yeo'\nc10_MPa = 1.0": "materials.x.model = 'yeo': did you mean 'yeoh'?",
    "[materials.x]\nmodel = 'mooney-rivlin'\nc10_MPa = 1.0\nc01_MPa = -1.0": (
        "materials.x: small-strain shear modulus = 0 MPa: 2 (c10_MPa + c01_MPa) must be above 0"
    ),
    "[materials.x]\nmodel = 'ogden'\nmu_MPa = [1.0]\nalpha = [1.0, 2.0]": (
        "materials.x.alpha has 2 values but mu_MPa has 1: one of each per term"
    ),
    "[materials.x]\nmodel = 'ogden'\nmu_MPa = [1.0]\nalpha = [-2.0]": (
        "materials.x: small-strain shear modulus = -1 MPa: half the sum of mu_MPa times alpha must be above 0"
    ),
    "[materials.x]\nmodel = 'hyperfoam'\nmu_MPa = [0.1]\nalpha = [8.0]\npoisson_ratio = [0.5]": (
        "materials.x.poisson_ratio[0] = 0.5: must be above -1 and below 0.5"
    ),
    "[materials.pvdf]\nyoungs_modulus_2_MPa = 9000.0": (
        "materials.pvdf.youngs_modulus_2_MPa = 9000: must be below 8442 for this poisson_ratio"
    ),
    "[segment.effector]\nmaterial = 'ruber'": (
        "segment.effector.material = 'ruber': no such material; did you mean 'rubber'?"
    ),
    "[segment.effector]\nmaterial = 'pvdf'": (
        "segment.effector.material = 'pvdf': this material is of model 'piezoelectric-film'; effector must not be one"
    ),
    # physics that is known but not modelled
    "[[mechanisms]]\nname = 'viscoelast'": "mechanisms[0].name = 'viscoelast': did you mean 'viscoelasticity'?",
    "[[mechanisms]]\nname = 'friction'\ncomponent = 'film'": ("mechanisms[0].component = 'film': friction acts on dot"),
    "[[mechanisms]]\nname = 'friction'\ncomponent = 'dot'\nparameters = {mu = 0.3}": (
        "mechanisms[0].parameters.mu: friction takes coefficient"
    ),
    "[[mechanisms]]\nname = 'viscoelasticity'\ncomponent = 'medium2'": (
        "mechanisms[0].parameters.relative_moduli is missing: viscoelasticity needs it"
    ),
    PRONY.format("[0.6, 0.4]", "[0.1, 1.0]"): (
        "mechanisms[0].parameters.relative_moduli = [0.6, 0.4]: their sum must be below 1"
    ),
    PRONY.format("[0.6]", "[0.1, 1.0]"): (
        "mechanisms[0].parameters.relaxation_times_s has 2 values but relative_moduli has 1: one of each per term"
    ),
    PRONY.format("[0.6]", "[0.1], flowing_share = 1.5"): (
        "mechanisms[0].parameters.flowing_share = 1.5: must be less than or equal to 1"
    ),
    PRONY.format("[0.6]", "[0.1], flowing_share = 0.5").replace("medium2", "film"): (
        "mechanisms[0].parameters.flowing_share = 0.5: 'film' is no medium of rubber; must be 0"
    ),
    PRONY.format("[0.6]", "[-0.1]"): ("mechanisms[0].parameters.relaxation_times_s.0 = -0.1: must be greater than 0"),
    "[[mechanisms]]\nname = 'friction'\ncomponent = 'dot'\nparameters = {coefficient = -0.1}": (
        "mechanisms[0].parameters.coefficient = -0.1: must be greater than or equal to 0"
    ),
    "[[mechanisms]]\nname = 'viscoelasticity'\ncomponent = 'bond-film-medium2'\n"
    "parameters = {relative_moduli = [0.5], relaxation_times_s = [1.0]}": (
        "mechanisms[0].component = 'bond-film-medium2': viscoelasticity needs a compliant bond there; "
        "add adhesive-compliance or segment.bonds"
    ),
    "[[mechanisms]]\nname = 'crosstalk'\ncomponent = 'channel-2-channel-3'\nparameters = {capacitance_pF = 9}": (
        "mechanisms[0].component = 'channel-2-channel-3': crosstalk needs that electrode and another one; "
        "segment.film.electrodes has 0"
    ),
    "[[mechanisms]]\nname = 'crosstalk'\ncomponent = 'channel-2-channel-3'\nparameters = {coupling = 0.1}": (
        "mechanisms[0].parameters.coupling = 0.1: is of one channel, two take capacitance_pF"
    ),
    "[[mechanisms]]\nname = 'low-pass'\ncomponent = 'channel-2'\nparameters = {cutoff_Hz = 9}": (
        "mechanisms[0].component = 'channel-2': low-pass needs that electrode and another one; "
        "segment.film.electrodes has 0"
    ),
    "[[mechanisms]]\nname = 'crosstalk'\ncomponent = 'channel-2'\nparameters = {coupling = 0.1}": (
        "mechanisms[0].component = 'channel-2': crosstalk needs that electrode and another one; "
        "segment.film.electrodes has 0"
    ),
    f"[[segment.bonds]]\nbetween = ['film', 'glue']\n{BOND}": (
        "segment.bonds[0].between[1] = 'glue': must be 'effector', 'medium1', 'film', 'medium2' or 'base'"
    ),
}


@pytest.mark.parametrize(("mistake", "sentence"), CASES.items())
def test_a_mistake_is_one_sentence(mistake, sentence, write_config, tmp_path, capfd):
    config = write_config(mistake)
    assert refusal(["run", str(config), "-o", str(tmp_path / "out")], tmp_path, capfd) == sentence


WHOLE_FILES = {
    MINIMAL.replace("2.0", "'2 mm'"): f"segment.medium2.thickness_mm = '2 mm': {NUMBER}",
    MINIMAL.replace("2.0", "-2.0"): "segment.medium2.thickness_mm = -2: must be above 0",
    MINIMAL.replace("0.5", "0"): "segment.medium1.thickness_mm = 0: must be above 0",
    MINIMAL.replace("28.0", "0.0"): "segment.film.thickness_um = 0: must be above 0",
    MINIMAL.replace("thickness_um", "thickness_mm"): (
        "segment.film.thickness_mm is not a key; did you mean 'thickness_um'? (mind the other unit)"
    ),
    "segment = 3": "segment = 3: must be a table",
    "materials = 3\n" + MINIMAL: "materials = 3: must be a table",
    "seed = -1\n" + MINIMAL: "seed = -1: must be at least 0",
    MINIMAL + "material = 'vnr_soft'": (
        "segment.medium2.material = 'vnr_soft': no such material; did you mean 'vnr-soft'?"
    ),
    MINIMAL.replace("thickness_um", "material = 'vnr'\nthickness_um"): (
        "segment.film.material = 'vnr': this material is of model 'neo-hookean'; the film needs a piezoelectric-film"
    ),
}


@pytest.mark.parametrize(("text", "sentence"), WHOLE_FILES.items())
def test_a_wrong_file_is_one_sentence(text, sentence, write_config, tmp_path, capfd):
    config = write_config(text, base="")
    assert refusal(["run", str(config), "-o", str(tmp_path / "out")], tmp_path, capfd) == sentence


IMPOSSIBLE = {
    "[segment.effector]\nshape = 'block'\nlength_mm = 3.0\nwidth_mm = 1.0": "segment.effector.length_mm = 3",
    "[segment.effector]\nshape = 'cylinder'\ndiameter_mm = 2.6": "segment.effector.diameter_mm = 2.6",
    "[press]\nindentation_mm = 2.6": "press.indentation_mm = 2.6",
    "[press]\nforce_N = 0.1\n[dot]\noffset_mm = [3.0, 0.0]": "dot.offset_mm[0] = 3: with press.force_N",
    "[dot]\nstandard = 'marburg'": "did you mean 'marburg-medium'?",
    "[dot]\ntilt_deg = [60.0, 0.0]": "overlaps the segment",
    "[dot]\ncell = 'x'": "dot.cell = 'x'",
    "[press.waveform]\nshape = 'file'\nfile = 'none.csv'": "press.waveform.file = 'none.csv': there is no such file",
    "[press]\npath_xy_mm = [[0.1, 0.0]]\n[press.waveform]\nshape = 'half-sine'": "press.waveform.shape = 'half-sine'",
}


@pytest.mark.parametrize(("mistake", "part"), IMPOSSIBLE.items())
def test_an_impossible_geometry_is_refused_by_name(mistake, part, write_config, tmp_path, capfd):
    config = write_config(mistake)
    assert part in refusal(["run", str(config), "-o", str(tmp_path / "out")], tmp_path, capfd)


def test_toml_that_is_none_is_refused_with_its_line(write_config, tmp_path, capfd):
    config = write_config("[press]\nindentation_mm 0.3", base="")
    said = refusal(["run", str(config), "-o", str(tmp_path / "out")], tmp_path, capfd)
    assert said.startswith(f"configuration '{config}': not valid TOML, ")
    assert "line 2" in said


def test_a_file_that_is_not_utf8_is_refused(tmp_path, capfd):
    config = tmp_path / "latin.toml"
    config.write_bytes("# Länge\n".encode("latin-1"))
    said = refusal(["run", str(config), "-o", str(tmp_path / "out")], tmp_path, capfd)
    assert said == f"configuration '{config}': not UTF-8 text (byte 3), save it as UTF-8"


def test_a_missing_file_is_refused(tmp_path, capfd):
    config = tmp_path / "nowhere.toml"
    said = refusal(["run", str(config), "-o", str(tmp_path / "out")], tmp_path, capfd)
    assert said == f"configuration '{config}': there is no such file"


def test_a_folder_as_configuration_is_refused(tmp_path, capfd):
    said = refusal(["run", str(tmp_path), "-o", str(tmp_path / "out")], tmp_path, capfd)
    assert said == f"configuration '{tmp_path}': this is a folder, a regular file is needed"


def test_nesting_without_end_is_refused(write_config, tmp_path, capfd):
    config = write_config("x = " + "[" * 100_000, base="")
    said = refusal(["run", str(config), "-o", str(tmp_path / "out")], tmp_path, capfd)
    assert said == f"configuration '{config}': brackets are nested too deeply"


@pytest.mark.process
@pytest.mark.parametrize("levels", [200, 20_000])
def test_a_key_of_many_levels_is_refused(write_config, tmp_path, capfd, levels):
    config = write_config(".".join(["x"] * levels) + " = 1", base="")
    said = refusal(["run", str(config), "-o", str(tmp_path / "out")], tmp_path, capfd)
    assert said == f"configuration '{config}': tables are nested more than 100 levels deep"


def test_a_long_key_is_not_echoed_whole(write_config, tmp_path, capfd):
    config = write_config("x" * 1_000_000 + " = 1", base="")
    assert len(refusal(["run", str(config), "-o", str(tmp_path / "out")], tmp_path, capfd)) < 500


@pytest.mark.parametrize("output", ["out\udcff", "out\0"])
def test_a_name_that_no_report_can_hold_is_refused(write_config, tmp_path, capfd, output):
    said = refusal(["run", str(write_config("")), "-o", str(tmp_path / output)], tmp_path, capfd)
    assert "must be text in UTF-8 without NUL characters" in said


def test_the_round_off_of_a_script_is_zero(write_config):
    from softdot.config.loading import load_config

    dot = load_config(write_config("[dot]\noffset_mm = [-1.1e-16, 0.0]\ngap_mm = -1.1e-16")).dot
    assert dot.offset_mm == (0.0, 0.0)
    assert dot.gap_mm == 0.0


TWICE = "[[mechanisms]]\nname = '{0}'\ncomponent = '{1}'\nparameters = {2}\n" * 2


def test_friction_stated_twice_is_refused(write_config, tmp_path, capfd):
    config = write_config(TWICE.format("friction", "dot", "{ coefficient = 0.1 }"))
    said = refusal(["run", str(config), "-o", str(tmp_path / "out")], tmp_path, capfd)
    assert said.startswith("mechanisms[1].name = 'friction': mechanisms[0] is the same at 'dot'")


def test_two_hums_superpose(write_config):
    from softdot.config.loading import load_config

    hum = TWICE.format("mains-hum", "readout", "{ frequency_Hz = 50.0, amplitude_V = 0.1 }")
    assert len(load_config(write_config(hum)).mechanisms) == 2


@pytest.mark.skipif("os.geteuid() == 0", reason="nothing is unreadable to root")
def test_an_unreadable_file_is_refused(write_config, tmp_path, capfd):
    config = write_config("")
    config.chmod(0)
    said = refusal(["run", str(config), "-o", str(tmp_path / "out")], tmp_path, capfd)
    assert said == f"configuration '{config}': cannot be read (Permission denied)"


@pytest.mark.press
def test_check_finds_what_a_kit_would_refuse(tmp_path, capsys):
    """Electrodes that touch can be simulated, and are one piece of metal."""
    rows = [
        f'{{name = "{name}", center_mm = [0.0, {y}], size_mm = [1.8, 1.2]}}' for name, y in (("a", 0.6), ("b", -0.6))
    ]
    text = ", ".join(rows)
    (tmp_path / "pair.toml").write_text(f"[segment.film]\nelectrodes = [{text}]\n")
    assert main(["check", str(tmp_path / "pair.toml"), "-q"]) == 0
    assert main(["check", str(tmp_path / "pair.toml"), "-q", "--kit"]) == 2
    assert "'a' and 'b' are 0 mm apart" in capsys.readouterr().err
