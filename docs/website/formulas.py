"""Formulas of the documents, written in TeX between dollars, as MathML."""

import html
import re

from latex2mathml.converter import convert

# what the Markdown extension arithmatex makes of $...$ and of $$...$$
INLINE = re.compile(r'<span class="arithmatex">\\\((.*?)\\\)</span>', re.DOTALL)
BLOCK = re.compile(r'<div class="arithmatex">\s*\\\[(.*?)\\\]\s*</div>', re.DOTALL)
# What the converter writes and browsers draw badly: a bar around a value as an operator with space on both sides, a bar
# over a letter as an arc.
BETTER = {
    '<mo stretchy="false">&#x0007C;</mo>': '<mo stretchy="false" lspace="0" rspace="0">&#x0007C;</mo>',
    "<mo>&#x0007C;</mo>": '<mo stretchy="false" lspace="0" rspace="0">&#x0007C;</mo>',
    '<mo stretchy="true">&#x000AF;</mo>': '<mo stretchy="false">&#x00304;</mo>',
}


def as_mathml(page: str) -> str:
    """The HTML of a page with every formula drawn by the browser."""
    page = BLOCK.sub(lambda found: _mathml(found[1], "block"), page)
    return INLINE.sub(lambda found: _mathml(found[1], "inline"), page)


def _mathml(tex: str, display: str) -> str:
    """One formula. ValueError where a command of TeX is left over, which would be shown as it is written."""
    tex = html.unescape(tex).strip()
    mathml: str = convert(tex, display=display)
    for written, better in BETTER.items():
        mathml = mathml.replace(written, better)
    left = re.search(r"<m\w+>\\\w+", mathml)
    if left is not None:
        raise ValueError(f"{left[0].partition('>')[2]} in ${tex}$: not known to latex2mathml")
    return mathml
