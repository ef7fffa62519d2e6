# Everything a fresh machine with cargo needs.
#   make demo    build isolux, light a room, leave picture, model and report in out/
#   make test    every test
#   make bench   speed of the ray kernel
#   make study-reference-rooms    real rooms against an independent renderer

ISOLUX = target/release/isolux

.PHONY: demo test bench lint build study-reference-rooms

build:
	cargo build --release --locked

demo: build
	@mkdir -p out
	$(ISOLUX) solve office --time 30 -o out/office.png -o out/office.glb -o out/office.json -o out/office.isolux
	@echo
	@echo "The picture is out/office.png, the lit model out/office.glb (any glTF viewer shows it),"
	@echo "the report out/office.json; look from elsewhere with: $(ISOLUX) render out/office.isolux -o out/again.png"

test:
	cargo test --release --locked --workspace

bench:
	cargo bench --locked --workspace

lint:
	cargo fmt --all --check
	cargo clippy --release --locked --workspace --all-targets -- -D warnings

study-reference-rooms:
	cargo run --release --locked -p isolux-testing --bin reference-rooms
