# SPDX-License-Identifier: GPL-3.0-or-later
python := .venv/bin/python

help:            ## this list
	@sed -n 's/^\([a-z-]*\):[^#]*## /  make \1\t/p' $(MAKEFILE_LIST) | expand -t 18

setup:           ## .venv with Blender's module, tests' packages and what they need from the system
	@PYTHON='$(PYTHON)' tools/setup.sh

test: setup      ## every test, under 15 minutes on two cores; make test PYTEST='tests/blender/test_package.py -k zip' for some
	$(python) -m pytest $(PYTEST)

lint: setup      ## ruff and mypy over the whole repository, as CI runs them
	$(python) -m ruff check .
	$(python) -m ruff format --check .
	$(python) -m mypy

desktop-test: package ## Afterlight in a full Blender's window, as a person works it; needs Linux and root, 2 GB the first time
	@tools/desktop.sh $(python) -m pytest --confcutdir=tests/desktop $(or $(PYTEST),tests/desktop)

package: setup   ## dist/afterlight-<version>.zip, to be installed in Blender
	$(python) tools/extension.py package

demo: package    ## before and after pictures of a sample scene, in build/demo; make demo DEMO=--all for all of them
	$(python) sample_blends/demo.py $(DEMO)

clip: package    ## moving shots by EEVEE alone and with Afterlight, in build/clip; make clip CLIP=pillars for one
	$(python) sample_blends/clip.py $(CLIP)

pictures: package ## the README's pictures of sample scenes and its clip, again
	$(python) sample_blends/demo.py cornell_box sunlit_room emissive_sign plastics --webp docs/pictures
	$(python) sample_blends/clip.py creature --size 320x180 --samples 8 --folder docs/pictures

samples: package ## write the sample scenes again from their scripts
	$(python) sample_blends/make_samples.py

bench: package   ## what it costs: beside EEVEE, by what the scene weighs, and alone on the GPU; two hours
	@status=0; for part in cost cost.constant_cost cost.tick gpu; do $(python) -m benchmarks.$$part || status=1; done; exit $$status

speed: setup     ## the last of these: the light alone, pass by pass, on this machine's GPU
	$(python) -m benchmarks.gpu

accuracy: package ## error beside EEVEE and denoised Cycles; an hour the first time; make accuracy ACCURACY='--scenes FOLDER' for yours
	$(python) -m benchmarks.accuracy $(or $(ACCURACY),--out docs/measured/accuracy --page docs/measured/accuracy.md)

motion: package  ## error, flicker, lag and trails in moving shots; make motion MOTION='pillars --frames 1-8' for less
	$(python) -m benchmarks.motion --page docs/measured/motion.md --sheet build/motion/sheet.webp $(MOTION)

soak: package    ## 300 frames in one process: does memory grow, does anything stay behind? Half an hour; needs Linux
	$(python) -m benchmarks.soak

stale:           ## pages with measured numbers that are older than the code they depend on
	@$(python) tools/stale.py

fuzz: setup      ## what people do to files in any order, and files that claim anything: an hour; make fuzz FUZZ='--minutes 5'
	cd tests && PYTHONPATH=.:../tools ../$(python) -m fuzz hour $(FUZZ)

clean:           ## remove what was made, but for .venv and the downloaded wheels
	rm -rf dist build .pytest_cache .hypothesis .ruff_cache .mypy_cache
	find . -path ./.venv -prune -o -name __pycache__ -type d -print0 | xargs -0 rm -rf

.PHONY: help setup test lint desktop-test package demo clip pictures samples bench speed accuracy motion soak stale fuzz clean
