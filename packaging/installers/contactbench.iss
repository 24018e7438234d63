; The installer for Windows. Inno Setup 6: iscc /DVersion=0.1.0 /DSource=FOLDER contactbench.iss

[Setup]
AppId={{6E6D0B1B-6C39-4C50-8A5E-8F1F6B6D7B11}
AppName=contactbench
AppVersion={#Version}
AppPublisher=The contactbench developers
DefaultDirName={autopf}\contactbench
DefaultGroupName=contactbench
ArchitecturesAllowed=x64compatible
ArchitecturesInstallIn64BitMode=x64compatible
; For one person without rights of an administrator, or for all.
PrivilegesRequired=lowest
PrivilegesRequiredOverridesAllowed=dialog
LicenseFile={#Source}\LICENSE
OutputBaseFilename=contactbench-{#Version}-setup
Compression=lzma2
SolidCompression=yes
ChangesAssociations=yes
ChangesEnvironment=yes

[Languages]
Name: "en"; MessagesFile: "compiler:Default.isl"
Name: "de"; MessagesFile: "compiler:Languages\German.isl"

[Tasks]
Name: "desktopicon"; Description: "{cm:CreateDesktopIcon}"; Flags: unchecked

[Files]
Source: "{#Source}\*"; DestDir: "{app}"; Flags: recursesubdirs ignoreversion

[Icons]
Name: "{group}\contactbench"; Filename: "{app}\contactbench-window.exe"
Name: "{autodesktop}\contactbench"; Filename: "{app}\contactbench-window.exe"; Tasks: desktopicon

[Registry]
Root: HKA; Subkey: "Software\Classes\.contactbench"; ValueType: string; ValueData: "contactbench.session"; Flags: uninsdeletevalue
Root: HKA; Subkey: "Software\Classes\contactbench.session"; ValueType: string; ValueData: "contactbench session"; Flags: uninsdeletekey
Root: HKA; Subkey: "Software\Classes\contactbench.session\shell\open\command"; ValueType: string; ValueData: """{app}\contactbench-window.exe"" gui ""%1"""

[Run]
Filename: "{app}\contactbench-window.exe"; Description: "{cm:LaunchProgram,contactbench}"; Flags: nowait postinstall skipifsilent
