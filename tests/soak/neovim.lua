-- Drives the language server and the debug adapter with Neovim's own clients, and writes what the
-- editor got as JSON to the file that $KRL_RESULT names. Set up by what docs/editors.md says.
local found = {}

local function wait(condition, what)
  assert(vim.wait(20000, condition, 20), "nothing came: " .. what)
end

local function line()
  return vim.api.nvim_get_current_line()
end

local function place(pattern)
  vim.fn.cursor(1, 1)
  assert(vim.fn.search(pattern, "cW") > 0, "not in the buffer: " .. pattern)
end

local function language_server()
  wait(function()
    return #vim.lsp.get_clients({ bufnr = 0 }) > 0
  end, "a client")
  local client = vim.lsp.get_clients({ bufnr = 0 })[1]
  wait(function()
    return #vim.diagnostic.get(0) > 0
  end, "findings")
  found.findings = vim.tbl_map(function(one)
    return { one.lnum + 1, one.code }
  end, vim.diagnostic.get(0))

  local function ask(method, more)
    local params = vim.tbl_extend("force", vim.lsp.util.make_position_params(0, client.offset_encoding), more or {})
    local answer = assert(client:request_sync(method, params, 60000, 0))
    assert(not answer.err, vim.inspect(answer.err))
    return answer.result
  end

  place("nParts, 1")
  found.hover = ask("textDocument/hover").contents.value
  found.references = #ask("textDocument/references", { context = { includeDeclaration = true } })
  found.highlights = #ask("textDocument/documentHighlight")
  place("1)")
  found.signature = ask("textDocument/signatureHelp").signatures[1].label
  place("nParts, 1")
  vim.fn.search("arts", "cW")
  local offered = ask("textDocument/completion")
  found.offers_the_name = vim.iter(offered.items or offered):any(function(one)
    return one.label == "nParts"
  end)
  found.hints = #ask("textDocument/inlayHint", {
    range = { start = { line = 0, character = 0 }, ["end"] = { line = 9, character = 0 } },
  })
  found.symbols = vim.tbl_map(function(one)
    return one.name
  end, ask("textDocument/documentSymbol"))
  vim.lsp.semantic_tokens.force_refresh(0)
  place("Fetch(nParts")
  wait(function()
    return #(vim.lsp.semantic_tokens.get_at_pos() or {}) > 0
  end, "semantic tokens")
  found.token = vim.lsp.semantic_tokens.get_at_pos()[1].type

  place("nParts, 1")
  vim.lsp.buf.rename("nPieces")
  wait(function()
    return vim.fn.search("nPieces", "cnw") > 0
  end, "the new name")
  found.renamed = line()
  place("STEP =")
  vim.lsp.buf.code_action({
    apply = true,
    filter = function(action)
      return action.isPreferred or action.title:find("leave out")
    end,
  })
  wait(function()
    return vim.fn.search("STEP =", "cnw") == 0
  end, "the fix")
  found.fixed = vim.trim(vim.fn.getline(4))
  vim.lsp.buf.format({ timeout_ms = 60000 })
  found.formatted = vim.fn.getline(5)

  place("nPieces")
  vim.lsp.buf.definition()
  wait(function()
    return vim.fn.expand("%:t") == "cell.dat"
  end, "the definition")
  found.definition = line()
  client:stop()
  wait(function()
    return client:is_stopped()
  end, "the end of the server")
end

local function debug_adapter()
  local dap = require("dap")
  local stops, ended, texts = 0, false, {}
  dap.listeners.after.event_stopped.test = function()
    stops = stops + 1
  end
  dap.listeners.after.event_exited.test = function(_, body)
    ended, found.exit = true, body.exitCode
  end

  local function stopped(act)
    local before = stops
    act()
    wait(function()
      local frame = dap.session() and dap.session().current_frame
      return stops > before and frame and dap.session().stopped_thread_id
    end, "a stop")
    local session, value = dap.session(), nil
    session:evaluate("N", function(error, answer)
      value = error and tostring(error) or answer.result
    end)
    wait(function()
      return value
    end, "a value")
    table.insert(texts, ("%d %s"):format(session.current_frame.line, value))
  end

  vim.fn.cursor(5, 1)
  dap.set_breakpoint("N==3")
  stopped(function()
    dap.run(vim.tbl_extend("force", dap.configurations.krl[1], { stopOnEntry = true }))
  end)
  stopped(dap.continue)
  stopped(dap.step_over)
  stopped(dap.step_back)
  stopped(dap.reverse_continue)
  found.stops = texts
  dap.clear_breakpoints()
  dap.continue()
  wait(function()
    return ended
  end, "the end of the program")
end

local function main()
  vim.cmd.edit("cell.src")
  found.filetype = vim.bo.filetype
  found.filetype_in_capitals = vim.filetype.match({ filename = "CELL.SRC" })
  language_server()
  vim.cmd("edit! loop1.src")
  debug_adapter()
end

local is_fine, why = xpcall(main, debug.traceback)
found.error = not is_fine and why or nil
vim.fn.writefile({ vim.json.encode(found) }, vim.env.KRL_RESULT)
vim.cmd("qall!")
