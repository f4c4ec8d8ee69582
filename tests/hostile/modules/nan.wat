;; A surface that answers NaN with every bit set, whatever it is asked.
(module
  (@custom "bidir.manifest" "{\"name\": \"nan\", \"kind\": \"bsdf\", \"lobes\": [\"diffuse_reflection\"]}")
  (memory (export "memory") 1)
  (func (export "bidir_abi") (result i32) i32.const 65536)
  (func (export "bidir_scratch") (param i32) (result i32) i32.const 1024)
  (func (export "bsdf_eval") (param $out i32) (param i32 i32 f32 f32 f32 f32 f32 f32)
    (memory.fill (local.get $out) (i32.const 255) (i32.const 20)))
  (func (export "bsdf_sample") (param $out i32) (param i32 i32 f32 f32 f32 f32 f32 f32)
    (memory.fill (local.get $out) (i32.const 255) (i32.const 40))
    (i32.store offset=32 (local.get $out) (i32.const 1))))
