;; Answers whatever its parameter block holds: 16 bytes for light_eval, the next 28 for light_emit.
(module
  (@custom "bidir.manifest" "{\"name\": \"echo\", \"kind\": \"light\", \"emits_from\": [\"area\", \"environment\"]}")
  (memory (export "memory") 1)
  (func (export "bidir_abi") (result i32) i32.const 65536)
  (func (export "bidir_scratch") (param i32) (result i32) i32.const 1024)
  (func (export "light_eval") (param $out i32) (param $params i32) (param f32 f32 f32 f32 f32)
    (memory.copy (local.get $out) (local.get $params) (i32.const 16)))
  (func (export "light_emit") (param $out i32) (param $params i32) (param f32 f32 f32 f32)
    (memory.copy (local.get $out) (i32.add (local.get $params) (i32.const 16)) (i32.const 28))))
